// What rviz shows beside the clouds: dynamic cells, objects with velocities, the grid's outline.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <utility>

#include <ros/time.h>
#include <visualization_msgs/MarkerArray.h>

#include "donex/detector.h"

namespace donex {

/// Makes marker arrays, each of which replaces the one before: markers that are gone or switched off are deleted.
class MarkerMaker {
 public:
  /// The markers of the detector's last scan that are switched on, in the odometry frame.
  visualization_msgs::MarkerArrayPtr make(const Detector& detector, const Config& config, const ros::Time& stamp,
                                          const std::string& odom_frame, const Eigen::Isometry3d& odom_from_world);

  /// Deletes all that is shown.
  visualization_msgs::MarkerArrayPtr clear();

 private:
  using Key = std::pair<std::string, std::int32_t>;  // namespace, id
  void deleteGone(visualization_msgs::MarkerArray& array);

  std::set<Key> shown_;
  std_msgs::Header header_;  // of what is shown
};

}  // namespace donex
