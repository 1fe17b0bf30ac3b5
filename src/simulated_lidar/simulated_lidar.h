// The simulated LiDAR as a ROS node: the default source where there is no sensor.
#pragma once

#include <memory>

#include <ros/node_handle.h>

namespace donex {

/// Publishes `points` (PointCloud2 of all sensors, see simulation_messages.h) and `odom` (Odometry) with `nh`, each in
/// its own rhythm by the wall clock, /tf_static (mounting) and, unless ~publish_tf is false, /tf (the odometry's
/// motion). Parameters: ~scene, ~odom_frame, ~base_frame, ~sensor_frame (of a single sensor), ~publish_tf, and
/// everything of SimulatorOptions by its name. Stamps are the wall clock's. Without a ~duration, or with 0, it goes on
/// for as long as it lives.
class SimulatedLidar {
 public:
  /// Throws std::invalid_argument with every fault of the parameters. Does not wait: the scene is built and played
  /// by a thread of its own.
  SimulatedLidar(const ros::NodeHandle& nh, const ros::NodeHandle& pnh);
  /// Returns soon, also in the middle of a scan.
  ~SimulatedLidar();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace donex
