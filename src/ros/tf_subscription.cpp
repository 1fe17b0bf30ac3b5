#include "ros/tf_subscription.h"

#include <ros/console.h>

namespace donex {

TfSubscription::TfSubscription(tf2_ros::Buffer& buffer, const ros::NodeHandle& nh) : buffer_(buffer), nh_(nh) {
  listen();
}

void TfSubscription::transformIsMissing() {
  constexpr double kRenewal = 5.0;  // [s]
  const bool is_due = (ros::WallTime::now() - listening_since_).toSec() >= kRenewal;
  if (!is_due) return;
  ROS_WARN_STREAM_NAMED("donex", "a transform is missing: subscribing to tf anew");
  listen();
}

void TfSubscription::listen() {
  listener_.reset();  // first: a topic with a subscriber left is not connected anew
  listener_ = std::make_unique<tf2_ros::TransformListener>(buffer_, nh_);
  listening_since_ = ros::WallTime::now();
}

}  // namespace donex
