// Low parts as low_parts.h and near_what_moves.h word them: each low echo against all that may be nearest to it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <vector>

#include "core/evidence/ground.h"
#include "core/evidence/judged_scan.h"
#include "core/sight/sight_history.h"
#include "donex/proof.h"

namespace donex::oracle {

/// Why an echo moves with what is close by (the first two), or does not.
enum class LowPart {
  kSeenThrough,
  kStandsOut,
  kMovesAnyway,
  kLeftOut,  ///< outside the region, not solid, or loose
  kTooHigh,
  kMirrored,
  kElsewhere,  ///< outside the square, or nowhere
  kFarAway,    ///< of all that moves
  kNearerToWhatStands,
  kSurface,  ///< an earlier scan saw one there
  kNotTouching,
  kNoGroundBeside,
  kNoHigherThanBeside,
};
constexpr std::size_t kLowParts = 13;

class LowParts {
 public:
  static constexpr float kCloseBy = 0.5F, kTouching = 0.3F, kStandsOut = 0.05F, kRoughness = 0.1F;  // [m]
  static constexpr float kClearance = 0.25F, kMargin = 0.25F;                                       // [m]
  static constexpr int kFarthestSide = 20;                                                          // steps

  LowParts(double reach, const JudgedScan& scan, const std::vector<std::uint8_t>& inside, const SightView& before,
           const Ground& ground, const std::vector<Proof>& proofs)
      : square_(static_cast<int>(std::ceil(reach / kCloseBy))),
        scan_(scan),
        inside_(inside),
        before_(before),
        ground_(ground),
        proofs_(proofs) {
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      if (moves(i)) take(i, lowest_moving_);
      if (stands(i)) take(i, lowest_standing_);
      if (!moves(i)) continue;
      const Cell cell = cellOf(scan.points[i]);
      for (const int x : {-1, 0, 1}) {
        for (const int y : {-1, 0, 1}) near_what_moves_.insert({cell[0] + x, cell[1] + y});
      }
    }
  }

  /// Of an echo of the cloud itself; `proof`: what it has in the end.
  LowPart judge(std::size_t echo, Proof& proof) const {
    proof = proofs_[echo];
    const Eigen::Vector3f& point = scan_.points[echo];
    if (proof != Proof::kNone) return LowPart::kMovesAnyway;
    if (!isInSquare(point)) return LowPart::kElsewhere;
    const bool takes_part = inside_[echo] != 0 && scan_.is_solid[echo] != 0;
    if (!takes_part || scan_.roles[echo] == ClusterRole::kLoose) return LowPart::kLeftOut;
    if (!(scan_.heights[echo] <= kClearance)) return LowPart::kTooHigh;
    if (!(scan_.heights[echo] > -kRoughness)) return LowPart::kMirrored;
    float moving = std::numeric_limits<float>::infinity(), standing = moving;
    Proof nearest = Proof::kNone;
    const auto away = [&](std::size_t i) { return (scan_.points[i] - point).head<2>().norm(); };
    for (const auto& [part, i] : lowest_moving_) {
      if (away(i) < moving) moving = away(i), nearest = proofs_[i];
    }
    for (const auto& [part, i] : lowest_standing_) standing = std::min(standing, away(i));
    if (!(moving <= kCloseBy)) return LowPart::kFarAway;
    if (!(moving < standing)) return LowPart::kNearerToWhatStands;
    const LowPart reason = judge(point, moving);
    if (reason == LowPart::kSeenThrough || reason == LowPart::kStandsOut) proof = nearest;
    return reason;
  }

 private:
  using Cell = std::array<int, 2>;

  Cell cellOf(const Eigen::Vector3f& point, int parts = 1) const {
    const Eigen::Vector3f away = (point - scan_.sensor) / kCloseBy * static_cast<float>(parts);
    return {static_cast<int>(std::floor(away.x())), static_cast<int>(std::floor(away.y()))};
  }
  /// The lowest echo of each part of a cell, the quarter of an edge.
  void take(std::size_t echo, std::map<Cell, std::size_t>& lowest) const {
    const auto [known, is_first] = lowest.emplace(cellOf(scan_.points[echo], 4), echo);
    if (!is_first && scan_.heights[echo] < scan_.heights[known->second]) known->second = echo;
  }
  bool isInSquare(const Eigen::Vector3f& point) const {
    if (!point.allFinite()) return false;
    const Cell cell = cellOf(point);
    return std::max(std::abs(cell[0]), std::abs(cell[1])) <= square_;
  }
  bool moves(std::size_t i) const { return proofs_[i] != Proof::kNone && isInSquare(scan_.points[i]); }
  bool stands(std::size_t i) const {
    return proofs_[i] == Proof::kNone && scan_.roles[i] == ClusterRole::kConnects && isInSquare(scan_.points[i]);
  }

  LowPart judge(const Eigen::Vector3f& point, float moving) const {
    const SightView::Evidence seen = before_.ask(point, -1e9, 1000, kMargin);
    if (seen.free > 0) return LowPart::kSeenThrough;
    if (seen.surface > 0) return LowPart::kSurface;
    if (!(moving <= kTouching)) return LowPart::kNotTouching;
    const Eigen::Vector2f ray = (point - scan_.sensor).head<2>().normalized();
    const Eigen::Vector2f left = kCloseBy * Eigen::Vector2f(-ray.y(), ray.x());
    const float above_left = heightBeside(point, left), above_right = heightBeside(point, -left);
    if (std::isinf(above_left) || std::isinf(above_right)) return LowPart::kNoGroundBeside;
    return std::min(above_left, above_right) > kStandsOut ? LowPart::kStandsOut : LowPart::kNoHigherThanBeside;
  }

  /// Above the ground a step beyond the first cell that is not near what moves.
  float heightBeside(Eigen::Vector3f point, const Eigen::Vector2f& step) const {
    for (int steps = 1; steps <= kFarthestSide; ++steps) {
      point.head<2>() += step;
      if (!isInSquare(point)) break;
      if (near_what_moves_.count(cellOf(point)) != 0) continue;
      point.head<2>() += step;
      return ground_.heightOf(point);
    }
    return std::numeric_limits<float>::infinity();
  }

  int square_;  ///< cells to each side of the sensor's
  const JudgedScan& scan_;
  const std::vector<std::uint8_t>& inside_;
  const SightView& before_;
  const Ground& ground_;
  const std::vector<Proof>& proofs_;
  std::set<Cell> near_what_moves_;
  std::map<Cell, std::size_t> lowest_moving_, lowest_standing_;
};

}  // namespace donex::oracle
