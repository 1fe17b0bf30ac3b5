#include "core/objects/apparent_shift.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace donex {

void ApparentShift::begin(const Eigen::Vector3d& sensor) {
  sensor_ = sensor.head<2>();
  ends_.clear();
  is_known_ = false;
  now_from_then_.setIdentity();
}

void ApparentShift::add(const Trace& then, const Segment& now) {
  const Eigen::Vector2d center = then.center().head<2>() - sensor_;
  for (const Eigen::Vector3d& shift : {Eigen::Vector3d(now.low - then.low), Eigen::Vector3d(now.high - then.high)}) {
    if (std::abs(shift.x()) < options_.most) ends_.push_back({{1.0, 0.0, -center.y()}, shift.x()});
    if (std::abs(shift.y()) < options_.most) ends_.push_back({{0.0, 1.0, center.x()}, shift.y()});
  }
}

void ApparentShift::solve() {
  if (ends_.size() < options_.least_ends) return;
  Eigen::Vector3d world = Eigen::Vector3d::Zero();
  const std::size_t standing_still = standing(world);
  double scale = options_.widest;
  for (int round = 0; round < options_.rounds; ++round) {
    world = reweighed(world, scale);
    scale = std::max(options_.has_stood, options_.narrowing * scale);
  }
  std::size_t standing_shifted = standing(world);
  const auto still = static_cast<double>(standing_still);
  if (static_cast<double>(standing_shifted) <= still + options_.least_gain * std::sqrt(still)) {
    world.setZero();
    standing_shifted = standing_still;
  }
  is_known_ = static_cast<double>(standing_shifted) >= options_.least_standing * static_cast<double>(ends_.size());
  if (!is_known_) return;
  const Eigen::Rotation2Dd turn(world.z());
  now_from_then_.linear().topLeftCorner<2, 2>() = turn.toRotationMatrix();
  now_from_then_.translation().head<2>() = sensor_ + world.head<2>() - turn * sensor_;
}

/// Ends that shift with the world.
std::size_t ApparentShift::standing(const Eigen::Vector3d& world) const {
  return static_cast<std::size_t>(std::count_if(ends_.begin(), ends_.end(), [&](const End& end) {
    return std::abs(end.slope.dot(world) - end.shift) < options_.has_stood;
  }));
}

/// Least squares, in which an end counts the less the farther it is from shifting with the world.
Eigen::Vector3d ApparentShift::reweighed(const Eigen::Vector3d& world, double scale) const {
  constexpr double kOfNothing = 1e-3;  // where the ends leave a direction open, nothing shifts in it
  Eigen::Matrix3d normal = kOfNothing * Eigen::Matrix3d::Identity();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const End& end : ends_) {
    const double squared = std::pow((end.slope.dot(world) - end.shift) / scale, 2);
    const double weight = 1.0 / (1.0 + squared * squared);
    normal += weight * end.slope * end.slope.transpose();
    right += weight * end.shift * end.slope;
  }
  return normal.ldlt().solve(right);
}

}  // namespace donex
