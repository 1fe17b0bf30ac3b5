// The lowest parts of what moves: feet, wheels, skirts (algorithm: "Low parts").
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/evidence/ground.h"
#include "core/evidence/judged_scan.h"
#include "core/sight/sight_history.h"
#include "donex/config.h"
#include "donex/proof.h"

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

  /// Hands the proof of what moves to its low parts. `inside`: one entry per echo of the cloud, whether it is in the
  /// region; `proofs`: one per entry of the scan. `before` and `ground` are asked in the scan's points.
  void join(const JudgedScan& scan, const std::vector<std::uint8_t>& inside, const SightView& before,
            const Ground& ground, std::vector<Proof>& proofs);

  std::size_t memoryBytes() const;
  /// What memoryBytes will be [bytes], about.
  static double bytesFor(double reach, const LowPartsOptions& options = {});

 private:
  static constexpr int kNone = -1;
  /// How far a cell is from what moves.
  enum class Nearness : std::uint8_t {
    kFar,
    kBeside,  ///< two cells away: what stands there may be nearer to an echo in a cell that is near
    kNear,    ///< it moves there, or one cell away
  };

  /// An echo of an object, in a list of those of its cell.
  struct Listed {
    std::uint32_t echo;
    int cell;
    int next;
  };
  /// Squared distances to the nearest echo that moves, and to the nearest that stands, horizontally [m^2].
  struct Nearest {
    float moving, standing;
    Proof proof;  ///< of the one that moves
  };

  static int widthOf(double reach, float cell);
  /// kNone outside the square, and at its rim of two cells.
  int cellAt(const Eigen::Vector2f& from_sensor) const;
  template <class Condition>
  void list(const JudgedScan& scan, Condition&& is_listed);
  /// Marks the cells around all that moves, up to so many away.
  void markAround(int reach, Nearness nearness);
  void forget();
  Nearest nearestTo(const JudgedScan& scan, std::uint32_t echo, int cell, const std::vector<Proof>& proofs) const;
  bool isLowPart(const JudgedScan& scan, std::uint32_t echo, float squared_distance, const SightView& before,
                 const Ground& ground) const;
  bool standsOut(const JudgedScan& scan, std::uint32_t echo, const Ground& ground) const;
  /// Height of an echo above the ground beside what moves, one step of `across` [m] after another; infinite where none
  /// is found.
  float heightBeside(const JudgedScan& scan, std::uint32_t echo, const Eigen::Vector2f& across,
                     const Ground& ground) const;

  LowPartsOptions options_;
  float clearance_;                 ///< [m]
  float margin_;                    ///< [m]
  int width_;                       ///< cells along an edge, each as long as `close_by`
  std::vector<Listed> listed_;      ///< all that moves, then what stands near it
  std::size_t moving_ = 0;          ///< how many of these move
  std::vector<int> first_in_;       ///< by cell: of listed_, or kNone
  std::vector<Nearness> nearness_;  ///< by cell
};

}  // namespace donex
