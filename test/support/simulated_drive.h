// Simulated scans with their truth, and how well labels match it.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "donex/detector.h"
#include "simulation/simulator.h"

namespace donex::testing {

struct TrueScan {
  Scan scan;
  std::vector<std::uint32_t> truth;  ///< as simulation::SimulatedScan::labels
};

/// Every `stride`-th echo of the first `scans` scans.
inline std::vector<TrueScan> simulatedDrive(const std::string& scene, int beams, int scans, std::size_t stride = 1,
                                            const simulation::DisturbanceOptions& disturbance = {}) {
  simulation::SimulatorOptions options;
  options.beams = beams;
  options.disturbance = disturbance;
  simulation::Simulator simulator(scene, options);
  std::vector<TrueScan> drive(static_cast<std::size_t>(scans));
  simulation::SimulatedScan simulated;
  for (TrueScan& next : drive) {
    if (!simulator.next(simulated)) throw std::runtime_error("the scene is over");
    next.scan = simulated.coreScan();
    next.truth = simulated.labels;
    for (std::size_t i = 0; i * stride < next.truth.size(); ++i) {
      next.scan.echoes[i] = next.scan.echoes[i * stride];
      next.truth[i] = next.truth[i * stride];
    }
    const std::size_t kept = (next.truth.size() + stride - 1) / stride;
    next.scan.echoes.resize(kept);
    next.truth.resize(kept);
  }
  return drive;
}

/// Pooled echoes within 50 m; those that the truth does not judge are left out.
struct Score {
  int right = 0, wrong = 0, missed = 0;

  void add(const TrueScan& truth, const EchoLabels& labels) {
    constexpr float kRange = 50.0F;
    constexpr std::uint32_t kFirstMoving = 252, kLastMoving = 259, kClass = 0xFFFF;
    for (std::size_t i = 0; i < truth.truth.size(); ++i) {
      const std::uint32_t label = truth.truth[i] & kClass;
      if (label == 0 || truth.scan.echoes[i].head<2>().norm() > kRange) continue;
      const bool moves = label >= kFirstMoving && label <= kLastMoving;
      const bool said = labels.dynamic[i] != 0;
      right += moves && said ? 1 : 0;
      wrong += !moves && said ? 1 : 0;
      missed += moves && !said ? 1 : 0;
    }
  }

  double iou() const { return static_cast<double>(right) / (right + wrong + missed); }
  double precision() const { return static_cast<double>(right) / (right + wrong); }
  double recall() const { return static_cast<double>(right) / (right + missed); }
};

}  // namespace donex::testing
