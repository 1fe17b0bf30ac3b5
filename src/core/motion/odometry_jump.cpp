#include "core/motion/odometry_jump.h"

#include <algorithm>

#include "donex/motion/rigid_motion.h"

namespace donex {

double OdometryJump::follow(double stamp, const Eigen::Isometry3d& odom_from_base) {
  const double elapsed = stamp - stamp_;
  const bool is_next = has_pose_ && elapsed > 0.0 && elapsed <= options_.longest_step;
  double jump = 0.0;
  if (is_next && has_step_) {
    const Eigen::Isometry3d predicted = pose_ * interpolate(Eigen::Isometry3d::Identity(), step_, elapsed / step_time_);
    const double error = (odom_from_base.translation() - predicted.translation()).norm();
    const double time = elapsed * std::max(elapsed, step_time_);
    if (error > options_.tolerance + options_.acceleration * time) jump = error;
  }
  // After a jump neither this step nor the one before tells of the next.
  has_step_ = is_next && !(jump > 0.0);
  if (has_step_) {
    step_ = pose_.inverse() * odom_from_base;
    step_time_ = elapsed;
  }
  has_pose_ = true;
  pose_ = odom_from_base;
  stamp_ = stamp;
  return jump;
}

}  // namespace donex
