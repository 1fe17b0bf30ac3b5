#include "core/motion/pose_and_twist.h"

namespace donex {

bool PoseAndTwist::standsStill(const OdometrySample& sample) {
  const double elapsed = sample.stamp - last_.stamp;
  const bool is_late = has_sample_ && elapsed <= 0.0;
  if (is_late) return false;
  const bool is_next = has_sample_ && elapsed <= options_.largest_gap && sample.twist.linear.allFinite();
  const bool stays = is_next && sample.odom_from_base.matrix() == last_.odom_from_base.matrix();
  way_ = stays ? way_ + elapsed * sample.twist.linear.norm() : 0.0;
  time_ = stays ? time_ + elapsed : 0.0;
  last_ = sample;
  has_sample_ = true;
  return way_ > options_.way && time_ > options_.time;
}

}  // namespace donex
