// An octree of what clouds show, as a ROS node: a consumer of ~static_points.
#pragma once

#include <cstddef>
#include <deque>
#include <string>

#include <ros/node_handle.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_ros/buffer.h>

#include "ros/octomap_builder.h"
#include "ros/tf_subscription.h"

namespace donex {

/// `points` (PointCloud2) into an octree in ~fixed_frame; ~cells (PointCloud2), its occupied leaves, once a second
/// while somebody listens. Parameters: ~fixed_frame and OctomapBuilder::Options by their names. All callbacks run on
/// nh's queue, which must be served by one thread at a time.
class OctomapNode {
 public:
  /// Throws std::invalid_argument with every fault of the parameters.
  OctomapNode(const ros::NodeHandle& nh, const ros::NodeHandle& pnh);

 private:
  struct Settings {
    OctomapBuilder::Options map;
    std::string fixed_frame = "odom";
  };
  struct Waiting {
    ros::WallTime since;
    sensor_msgs::PointCloud2ConstPtr cloud;
  };
  static Settings readSettings(const ros::NodeHandle& pnh);

  void onCloud(const sensor_msgs::PointCloud2ConstPtr& cloud);
  void work();
  void giveUpTheLate(const ros::WallTime& now);
  bool addNewest();
  void add(const sensor_msgs::PointCloud2& cloud);
  void leaveOut(const std::string& why);
  void publish();

  Settings settings_;
  OctomapBuilder map_;
  std::deque<Waiting> waiting_;             ///< as they came
  std::size_t arrived_ = 0, left_out_ = 0;  ///< clouds
  ros::Time stamp_;                         ///< of the cloud that was added last
  tf2_ros::Buffer tf_;
  TfSubscription tf_subscription_;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
  ros::WallTimer work_timer_, publish_timer_;
};

}  // namespace donex
