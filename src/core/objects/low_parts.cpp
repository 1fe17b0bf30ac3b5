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
      clearance_(static_cast<float>(config.ground_clearance)),
      margin_(options.margin * static_cast<float>(config.sight_margin)),
      width_(widthOf(reach, options.close_by)),
      first_in_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(width_), kNone),
      nearness_(first_in_.size(), Nearness::kFar) {}

int LowParts::widthOf(double reach, float cell) { return 2 * static_cast<int>(std::ceil(reach / cell)) + 5; }

int LowParts::cellAt(const Eigen::Vector2f& from_sensor) const {
  const Eigen::Array2f cell = (from_sensor.array() / options_.close_by).floor() + static_cast<float>(width_ / 2);
  const bool is_within = (cell >= 2.0F).all() && (cell < static_cast<float>(width_ - 2)).all();
  return is_within ? static_cast<int>(cell.y()) * width_ + static_cast<int>(cell.x()) : kNone;
}

void LowParts::join(const JudgedScan& scan, const std::vector<std::uint8_t>& inside, const SightView& before,
                    const Ground& ground, std::vector<Proof>& proofs) {
  if (!scan.has_ground) return;
  list(scan, [&](std::size_t i) { return proofs[i] != Proof::kNone; });
  moving_ = listed_.size();
  if (moving_ == 0) return;
  markAround(2, Nearness::kBeside);
  markAround(1, Nearness::kNear);
  list(scan, [&](std::size_t i) { return scan.roles[i] == ClusterRole::kConnects && proofs[i] == Proof::kNone; });
  const auto is_low = [&](std::size_t i) {
    const ClusterRole role = scan.roles[i];
    const int connects_nothing =
        static_cast<int>(role == ClusterRole::kNone) | static_cast<int>(role == ClusterRole::kFollows);
    const int is_near_ground =
        static_cast<int>(scan.heights[i] <= clearance_) & static_cast<int>(scan.heights[i] > -options_.roughness);
    return (connects_nothing & is_near_ground & inside[i] & scan.is_solid[i]) != 0;
  };
  forEachSelection(0, scan.own(), is_low, [&](const std::uint32_t* low, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) {
      const std::uint32_t echo = low[k];
      const int cell = cellAt((scan.points[echo] - scan.sensor).head<2>());
      const bool is_asked = cell != kNone && nearness_[static_cast<std::size_t>(cell)] == Nearness::kNear;
      if (!is_asked || proofs[echo] != Proof::kNone) continue;
      const Nearest nearest = nearestTo(scan, echo, cell, proofs);
      const bool is_beside =
          nearest.moving <= options_.close_by * options_.close_by && nearest.moving < nearest.standing;
      if (is_beside && isLowPart(scan, echo, nearest.moving, before, ground)) proofs[echo] = nearest.proof;
    }
  });
  forget();
}

/// Adds to the lists of their cells: once it is known what moves, only beside that.
template <class Condition>
void LowParts::list(const JudgedScan& scan, Condition&& is_listed) {
  forEachSelection(0, scan.points.size(), is_listed, [&](const std::uint32_t* chosen, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) {
      const int cell = cellAt((scan.points[chosen[k]] - scan.sensor).head<2>());
      if (cell == kNone || (moving_ > 0 && nearness_[static_cast<std::size_t>(cell)] == Nearness::kFar)) continue;
      int& first = first_in_[static_cast<std::size_t>(cell)];
      listed_.push_back({chosen[k], cell, first});
      first = static_cast<int>(listed_.size()) - 1;
    }
  });
}

void LowParts::markAround(int reach, Nearness nearness) {
  for (std::size_t k = 0; k < moving_; ++k) {
    for (int row = -reach; row <= reach; ++row) {
      std::fill_n(nearness_.data() + listed_[k].cell + row * width_ - reach, 2 * reach + 1, nearness);
    }
  }
}

void LowParts::forget() {
  markAround(2, Nearness::kFar);
  for (const Listed& listed : listed_) first_in_[static_cast<std::size_t>(listed.cell)] = kNone;
  listed_.clear();
  moving_ = 0;
}

/// Of the echoes in the cell and the eight around it: none elsewhere is close by.
LowParts::Nearest LowParts::nearestTo(const JudgedScan& scan, std::uint32_t echo, int cell,
                                      const std::vector<Proof>& proofs) const {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  Nearest nearest{kFar, kFar, Proof::kNone};
  const Eigen::Vector2f at = scan.points[echo].head<2>();
  for (const int row : {-width_, 0, width_}) {
    for (int beside = cell + row - 1; beside <= cell + row + 1; ++beside) {
      for (int k = first_in_[static_cast<std::size_t>(beside)]; k != kNone;
           k = listed_[static_cast<std::size_t>(k)].next) {
        const std::uint32_t other = listed_[static_cast<std::size_t>(k)].echo;
        const float distance = (scan.points[other].head<2>() - at).squaredNorm();
        const bool moves = static_cast<std::size_t>(k) < moving_;
        if (moves && distance < nearest.moving) nearest.proof = proofs[other];
        float& shortest = moves ? nearest.moving : nearest.standing;
        shortest = std::min(shortest, distance);
      }
    }
  }
  return nearest;
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
    const int cell = cellAt((at - scan.sensor).head<2>());
    if (cell == kNone) break;
    if (nearness_[static_cast<std::size_t>(cell)] == Nearness::kNear) continue;
    at.head<2>() += across;  // cells of the ground are larger: that there may have been lifted, too
    return ground.heightOf(at);
  }
  return std::numeric_limits<float>::infinity();
}

double LowParts::bytesFor(double reach, const LowPartsOptions& options) {
  return std::pow(widthOf(reach, options.close_by), 2) * (sizeof(int) + sizeof(Nearness));
}

std::size_t LowParts::memoryBytes() const {
  return listed_.capacity() * sizeof(Listed) + first_in_.capacity() * sizeof(int) + nearness_.capacity();
}

}  // namespace donex
