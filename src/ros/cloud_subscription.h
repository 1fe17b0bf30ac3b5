// The topic of the clouds, whichever of the types that are read its publisher sends.
#pragma once

#include <functional>
#include <string>

#include <ros/node_handle.h>
#include <sensor_msgs/PointCloud2.h>

namespace donex {

struct CloudReceiver {
  std::function<void(const sensor_msgs::PointCloud2ConstPtr& cloud)> cloud;
  /// A message that is none of a type that is read, or not whole: why, in words.
  std::function<void(const std::string& why)> unreadable;
};

/// sensor_msgs/PointCloud2, which within a process stay the publisher's own objects, and Livox' CustomMsg, which
/// becomes one. `receiver` is called on the callback queue, a message at a time.
ros::Subscriber subscribeToClouds(ros::NodeHandle& nh, const std::string& topic, std::uint32_t queue_size,
                                  const CloudReceiver& receiver);

}  // namespace donex
