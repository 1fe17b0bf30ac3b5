// Scans cut by azimuth.
#pragma once

#include <vector>

#include "core/sector.h"
#include "donex/scan.h"

namespace donex::testing {

/// The scan's echoes by azimuth, in clouds that come one after the other within `duration` [s].
inline std::vector<Scan> sectorsOf(const Scan& scan, std::size_t count, double duration = 0.0) {
  Scan none = scan;
  none.echoes.clear();
  std::vector<Scan> sectors(count, none);
  for (std::size_t k = 0; k < count; ++k) {
    sectors[k].stamp += duration * static_cast<double>(k) / static_cast<double>(count);
  }
  for (const Eigen::Vector3f& echo : scan.echoes) sectors[sectorOf(echo, count)].echoes.push_back(echo);
  return sectors;
}

}  // namespace donex::testing
