#include "core/methods/stream_guard.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace donex {
namespace {

void check(const Eigen::Isometry3d& pose, const char* name) {
  const bool is_near = pose.translation().norm() < StreamGuard::kFarthestPose;  // false for NaN
  const bool is_rotation = pose.linear().isUnitary(1e-6) && pose.linear().determinant() > 0.0;
  if (!is_near) throw std::invalid_argument(std::string(name) + ": translation is not finite or beyond 1e7 m");
  if (!is_rotation) throw std::invalid_argument(std::string(name) + ": the linear part is not a rotation");
}

}  // namespace

void StreamGuard::admit(const Scan& scan) {
  check(scan.odom_from_base, "pose of the vehicle");
  check(scan.base_from_sensor, "mounting of the sensor");
  const bool has_returns = scan.second_returns.empty() || scan.second_returns.size() == scan.echoes.size();
  if (!has_returns) throw std::invalid_argument("second returns: an entry per echo is needed, or none");
  const bool is_in_order = scan.stamp >= last_stamp_ && std::isfinite(scan.stamp);
  if (!is_in_order) {
    throw std::invalid_argument("scan at " + std::to_string(scan.stamp) + " s is earlier than the last one at " +
                                std::to_string(last_stamp_) + " s");
  }
  last_stamp_ = scan.stamp;
}

}  // namespace donex
