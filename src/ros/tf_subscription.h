// tf, subscribed to anew while a transform is missing.
#pragma once

#include <memory>

#include <ros/node_handle.h>
#include <ros/time.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

namespace donex {

/// Fills a buffer from /tf and /tf_static, on a thread of its own.
class TfSubscription {
 public:
  TfSubscription(tf2_ros::Buffer& buffer, const ros::NodeHandle& nh);

  /// To be told of each transform that is missing: /tf_static is sent once to each subscriber, and whoever missed it
  /// would wait for ever. Subscribes anew, once in 5 s at most.
  void transformIsMissing();

 private:
  void listen();

  tf2_ros::Buffer& buffer_;
  ros::NodeHandle nh_;
  std::unique_ptr<tf2_ros::TransformListener> listener_;
  ros::WallTime listening_since_;
};

}  // namespace donex
