// Why the detector with evidence labelled as it did: computed on demand, from what it holds of the last scan.
#pragma once

#include <cstdint>
#include <vector>

#include "core/evidence/judged_scan.h"
#include "core/evidence/newness.h"
#include "core/sight/sight_history.h"
#include "donex/config.h"
#include "donex/explanation.h"
#include "donex/proof.h"

namespace donex {

/// 1 where an echo is proven to move.
std::vector<std::uint8_t> movingEchoes(const std::vector<Proof>& proofs);

/// One per echo. `inside`: the echo hits the grid.
std::vector<EchoReason> reasonsOf(const JudgedScan& scan, const std::vector<std::uint8_t>& inside,
                                  const std::vector<Proof>& proofs);

/// De-shadowing is asked only where something is hit again; here it is asked of every voxel that is not hit.
MemoryCells memoryCellsOf(const Newness3d& places, const ScanClock& clock, const EvidenceConfig& config,
                          const SightHistory& sights, const Eigen::Isometry3d& odom_from_points);
/// The 2D grid has no cells to show.
inline MemoryCells memoryCellsOf(const Newness2d&, const ScanClock&, const EvidenceConfig&, const SightHistory&,
                                 const Eigen::Isometry3d&) {
  return {};
}

}  // namespace donex
