// A transform that its first subscriber never hears of.
#pragma once

#include <atomic>
#include <string>

#include <ros/ros.h>
#include <tf2_msgs/TFMessage.h>

#include "ros/manager_rig.h"

namespace donex::test {

/// A latched transform that says nothing to its first subscriber, as if the message had been lost, and tells every
/// later one. The child lies 2 m above the parent.
class LostTransform {
 public:
  LostTransform(const std::string& parent, const std::string& child) {
    mounting_.transforms.push_back(transformAt(0.0, parent, child, 0.0, 2.0));
    publisher_ = ros::NodeHandle().advertise<tf2_msgs::TFMessage>(
        "/tf_static", 10, [this](const ros::SingleSubscriberPublisher& subscriber) { answer(subscriber); });
  }
  int subscribers() const { return subscribers_; }

 private:
  void answer(const ros::SingleSubscriberPublisher& subscriber) {
    if (++subscribers_ > 1) subscriber.publish(mounting_);
  }

  tf2_msgs::TFMessage mounting_;
  std::atomic<int> subscribers_{0};
  ros::Publisher publisher_;
};

}  // namespace donex::test
