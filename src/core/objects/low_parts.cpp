#include "core/objects/low_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/grid/selection.h"

namespace donex {
namespace {

constexpr double kEver = -std::numeric_limits<double>::infinity();

}  // namespace

LowParts::LowParts(double reach, const EvidenceConfig& config, const LowPartsOptions& options)
    : options_(options),
      margin_(options.margin * static_cast<float>(config.sight_margin)),
      near_(reach, options.close_by) {}

void LowParts::join(const JudgedScan& scan, const std::vector<std::uint8_t>& inside, const SightView& before,
                    const Ground& ground, const Verdicts& verdicts, Segments& segments, std::vector<Proof>& proofs) {
  if (!scan.has_ground || !near_.take(scan, segments, verdicts, proofs)) return;
  const auto is_low = [&](std::size_t i) {
    const bool connects_nothing = scan.roles[i] == ClusterRole::kNone || scan.roles[i] == ClusterRole::kFollows;
    return connects_nothing && scan.heights[i] > -options_.roughness && inside[i] != 0 && scan.is_solid[i] != 0;
  };
  // Few are near, mostly one after another.
  const auto is_asked = [&](std::size_t i) {
    return near_.of(i) == NearWhatMoves::Nearness::kNear && proofs[i] == Proof::kNone && is_low(i);
  };
  forEachSelection(0, scan.own(), is_asked, [&](const std::uint32_t* low, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) {
      const NearWhatMoves::Nearest nearest = near_.nearestTo(low[k]);
      const bool is_beside = nearest.segment != NearWhatMoves::kStands;
      if (!is_beside || !isLowPart(scan, low[k], nearest.squared_distance, before, ground)) continue;
      const auto segment = static_cast<std::size_t>(nearest.segment);
      proofs[low[k]] = verdicts[segment].proof;
      segments[segment].echoes.push_back(low[k]);
    }
  });
  near_.forget();
}

bool LowParts::isLowPart(const JudgedScan& scan, std::uint32_t echo, float squared_distance, const SightView& before,
                         const Ground& ground) const {
  const SightView::Evidence seen = before.ask(scan.points[echo], kEver, 1, margin_);
  if (seen.free > 0) return true;
  const bool touches = squared_distance <= options_.touching * options_.touching;
  return touches && seen.surface == 0 && standsOut(scan, echo, ground);
}

/// Neither side may be as high: one of them is the pavement that somebody walks along.
bool LowParts::standsOut(const JudgedScan& scan, std::uint32_t echo, const Ground& ground) const {
  const Eigen::Vector2f ray = (scan.points[echo] - scan.sensor).head<2>().normalized();
  const Eigen::Vector2f across = options_.close_by * Eigen::Vector2f(-ray.y(), ray.x());
  const float left = heightBeside(scan, echo, across, ground), right = heightBeside(scan, echo, -across, ground);
  return std::isfinite(left) && std::isfinite(right) && std::min(left, right) > options_.stands_out;
}

float LowParts::heightBeside(const JudgedScan& scan, std::uint32_t echo, const Eigen::Vector2f& across,
                             const Ground& ground) const {
  Eigen::Vector3f at = scan.points[echo];
  const int steps = static_cast<int>(options_.farthest_side / options_.close_by);
  for (int step = 0; step < steps; ++step) {
    at.head<2>() += across;
    const NearWhatMoves::Nearness nearness = near_.at((at - scan.sensor).head<2>());
    if (nearness == NearWhatMoves::Nearness::kOutside) break;
    if (nearness == NearWhatMoves::Nearness::kNear) continue;
    at.head<2>() += across;  // cells of the ground are larger: that there may have been lifted, too
    return ground.heightOf(at);
  }
  return std::numeric_limits<float>::infinity();
}

}  // namespace donex
