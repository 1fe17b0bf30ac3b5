// The ego motion that was found in the clouds, for others.
#pragma once

#include <memory>

#include <nav_msgs/Odometry.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <tf2_ros/transform_broadcaster.h>

#include "ros/pipeline.h"

namespace donex {

/// The pose of the vehicle at the scan's stamp, and its velocity since the scan before where there is one.
nav_msgs::Odometry toOdometry(const LabeledScan& scan);

/// ~odometry, and on request tf from the odometry frame to the vehicle's.
class OdometryPublisher {
 public:
  OdometryPublisher(ros::NodeHandle pnh, const MotionConfig& config);

  /// Nothing where the motion was not found in the clouds.
  void publish(const LabeledScan& scan);

 private:
  ros::Publisher odometry_;  // none where the motion comes from elsewhere
  std::unique_ptr<tf2_ros::TransformBroadcaster> tf_;
};

}  // namespace donex
