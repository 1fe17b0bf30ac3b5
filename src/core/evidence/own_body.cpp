#include "core/evidence/own_body.h"

#include <algorithm>
#include <cmath>

namespace donex {
namespace {

Eigen::Array3f halfOf(const OwnBody::Options& options) {
  return Eigen::Array3d(options.reach, options.half_width, options.half_height).cast<float>();
}

Eigen::Vector3i sizeOf(const OwnBody::Options& options) {
  return (2.0F * halfOf(options) / static_cast<float>(options.cell)).ceil().cast<int>();
}

}  // namespace

OwnBody::OwnBody(const SelfConfig& config, const Options& options)
    : config_(config),
      options_(options),
      half_(halfOf(options)),
      size_(sizeOf(options)),
      counts_(config.detection ? static_cast<std::size_t>(size_.prod()) : 0, 0),
      hit_(counts_.size(), 0) {}

bool OwnBody::isInBox(const Eigen::Vector3f& in_vehicle) const {
  const Eigen::Vector3d point = in_vehicle.cast<double>();
  return point.x() >= config_.x_min && point.x() < config_.x_max && point.y() >= config_.y_min &&
         point.y() < config_.y_max && point.z() >= config_.z_min && point.z() < config_.z_max;
}

int OwnBody::cellOf(const Eigen::Vector3f& in_vehicle) const {
  const Eigen::Array3f from_center = (in_vehicle - center_).array();
  const bool is_near = (from_center.abs() < half_).all();  // false for NaN
  if (!is_near) return kNone;
  const Eigen::Array3i cell = ((from_center + half_) / static_cast<float>(options_.cell)).cast<int>();
  return (cell.z() * size_.y() + cell.y()) * size_.x() + cell.x();
}

/// From a sensor that sits at `mounting`, no cell is farther away [m].
float OwnBody::farthestFrom(const Eigen::Vector3f& mounting) const {
  return half_.matrix().norm() + (mounting - center_).norm();
}

void OwnBody::leaveOut(const Scan& scan, std::size_t first, std::size_t last,
                       std::vector<std::uint8_t>& is_solid) const {
  if (!is_found_ && !hasBox()) return;
  const Eigen::Isometry3f base_from_sensor = scan.base_from_sensor.cast<float>();
  const float farthest = detects() ? farthestFrom(base_from_sensor.translation()) : 0.0F;
  for (std::size_t i = first; i < last; ++i) {
    const bool may_be_in_a_cell = scan.echoes[i].squaredNorm() < farthest * farthest;
    if (!may_be_in_a_cell && !hasBox()) continue;
    const Eigen::Vector3f place = base_from_sensor * scan.echoes[i];
    const int cell = may_be_in_a_cell ? cellOf(place) : kNone;
    const bool stays = cell != kNone && counts_[static_cast<std::size_t>(cell)] >= options_.body;
    if (stays || isInBox(place)) is_solid[i] = 0;
  }
}

void OwnBody::learn(TurnPart part, const Scan& scan, const std::vector<std::uint8_t>& is_echo,
                    const std::vector<float>& heights, float lowest) {
  if (!detects()) return;
  if (part != TurnPart::kContinuing) beginTurn(scan);
  if (!is_counting_) return;
  const Eigen::Isometry3f base_from_sensor = scan.base_from_sensor.cast<float>();
  const float farthest = farthestFrom(base_from_sensor.translation());
  for (std::size_t i = 0; i < scan.echoes.size(); ++i) {
    const bool may_count = is_echo[i] != 0 && scan.echoes[i].squaredNorm() < farthest * farthest && heights[i] > lowest;
    const int cell = may_count ? cellOf(base_from_sensor * scan.echoes[i]) : kNone;
    if (cell != kNone) hit_[static_cast<std::size_t>(cell)] = 1;
  }
}

void OwnBody::beginTurn(const Scan& scan) {
  if (is_counting_) count();
  const Eigen::Vector3d place = scan.odom_from_base.translation();
  if (!has_place_) center_ = scan.base_from_sensor.translation().cast<float>();
  is_counting_ = has_place_ && (place - last_place_).norm() >= options_.step;
  if (!has_place_ || is_counting_) last_place_ = place;
  has_place_ = true;
}

void OwnBody::count() {
  is_found_ = false;
  for (std::size_t cell = 0; cell < counts_.size(); ++cell) {
    const int count = counts_[cell] + (hit_[cell] != 0 ? options_.gain : -options_.loss);
    counts_[cell] = static_cast<std::uint8_t>(std::clamp(count, 0, options_.most));
    is_found_ = is_found_ || counts_[cell] >= options_.body;
  }
  std::fill(hit_.begin(), hit_.end(), std::uint8_t{0});
}

void OwnBody::reset() {
  std::fill(counts_.begin(), counts_.end(), std::uint8_t{0});
  std::fill(hit_.begin(), hit_.end(), std::uint8_t{0});
  has_place_ = is_counting_ = is_found_ = false;
}

double OwnBody::bytesFor(const SelfConfig& config) {
  return config.detection ? 2.0 * static_cast<double>(sizeOf(Options()).prod()) : 0.0;
}

}  // namespace donex
