// The lowest parts of what moves: feet, wheels, skirts (algorithm: "Low parts").
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/evidence/ground.h"
#include "core/evidence/judged_scan.h"
#include "core/objects/near_what_moves.h"
#include "core/sight/sight_history.h"
#include "donex/config.h"

namespace donex {

struct LowPartsOptions {
  float close_by = 0.5F;        ///< so near to an echo that moves a low one may be of the same object [m]
  float touching = 0.3F;        ///< so near where no scan saw through its place [m]
  float stands_out = 0.05F;     ///< of the ground on both sides of the object, where no scan did [m]
  float farthest_side = 10.0F;  ///< where that ground is looked for: beyond half a lorry [m]
  float roughness = 0.1F;       ///< echoes farther beneath the ground's height are mirrored [m]
  float margin = 0.5F;          ///< of the sight's: what lies on the ground has it right behind
};

/// Echoes below the ground clearance take part in no segment, since the ground beside what moves would connect it with
/// all that stands. They move with what is close by, nearer than anything that stands, if an earlier scan saw through
/// their place, or if none saw a surface there and they stand out of the ground to the left and right, which holds on
/// slopes and where the object itself was taken for the ground.
class LowParts {
 public:
  /// A square of `reach` [m] around the sensor.
  LowParts(double reach, const EvidenceConfig& config, const LowPartsOptions& options = {});

  /// Adds their low parts to the segments that move, and hands them the proof. `inside`: one entry per echo of the
  /// cloud, whether it is in the region; `proofs`: one per entry of the scan. `before` and `ground` are asked in its
  /// points.
  void join(const JudgedScan& scan, const std::vector<std::uint8_t>& inside, const SightView& before,
            const Ground& ground, const Verdicts& verdicts, Segments& segments, std::vector<Proof>& proofs);

  std::size_t memoryBytes() const { return near_.memoryBytes(); }
  /// What memoryBytes will be, for scans of so many echoes [bytes], about.
  static double bytesFor(double reach, double echoes, const LowPartsOptions& options = {}) {
    return NearWhatMoves::bytesFor(reach, options.close_by, echoes);
  }

 private:
  bool isLowPart(const JudgedScan& scan, std::uint32_t echo, float squared_distance, const SightView& before,
                 const Ground& ground) const;
  bool standsOut(const JudgedScan& scan, std::uint32_t echo, const Ground& ground) const;
  /// Height of an echo above the ground beside what moves, one step of `across` [m] after another; infinite where none
  /// is found.
  float heightBeside(const JudgedScan& scan, std::uint32_t echo, const Eigen::Vector2f& across,
                     const Ground& ground) const;

  LowPartsOptions options_;
  float margin_;  ///< [m]
  NearWhatMoves near_;
};

}  // namespace donex
