// An octree of what clouds show, as a ROS node: a consumer of ~static_points.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <string>
#include <thread>

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
  ~OctomapNode();

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

  // On the callbacks' thread, so that clouds do not pile up while one is added.
  void onCloud(const sensor_msgs::PointCloud2ConstPtr& cloud);
  void giveUpTheLate(const ros::WallTime& now);

  // On a thread of the map's own.
  void run();
  bool addNewest();
  void add(const sensor_msgs::PointCloud2& cloud);
  void publish();

  void leaveOut(const std::string& why);

  Settings settings_;
  OctomapBuilder map_;
  ros::Time stamp_;           ///< of the cloud that was added last
  ros::WallTime publish_at_;  ///< or later
  tf2_ros::Buffer tf_;
  TfSubscription tf_subscription_;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;

  std::mutex mutex_;  ///< of what follows
  std::condition_variable wake_;
  std::deque<Waiting> waiting_;             ///< as they came
  std::size_t arrived_ = 0, left_out_ = 0;  ///< clouds
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace donex
