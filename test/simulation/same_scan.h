// Scans that are the same bit for bit.
#pragma once

#include <algorithm>

#include "simulation/simulator.h"

namespace donex::simulation {

inline bool sameRay(const SimulatedEcho& a, const SimulatedEcho& b) {
  return a.position == b.position && a.intensity == b.intensity && a.ring == b.ring;
}

inline bool sameScan(const SimulatedScan& a, const SimulatedScan& b) {
  const auto same = [](const SimulatedEcho& p, const SimulatedEcho& q) { return sameRay(p, q) && p.time == q.time; };
  return a.labels == b.labels && a.stamp == b.stamp && a.sent == b.sent &&
         std::equal(a.echoes.begin(), a.echoes.end(), b.echoes.begin(), b.echoes.end(), same);
}

}  // namespace donex::simulation
