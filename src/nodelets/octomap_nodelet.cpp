// donex/OctomapNodelet: `points` (PointCloud2) into an octree in ~fixed_frame, ~cells (PointCloud2) once a second.
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>
#include <ros/ros.h>
#include <tf2_eigen/tf2_eigen.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include "ros/octomap_builder.h"
#include "ros/parameters.h"
#include "ros/strict_parameters.h"

namespace donex {
namespace {

/// A range that may be switched off with 0.
void requireRangeOrNone(const char* name, double value, double low, double high, std::vector<std::string>& faults) {
  const bool is_none = value == 0.0;
  const bool is_inside = value >= low && value <= high;  // false for NaN
  if (!is_none && !is_inside) {
    faults.push_back(fmt::format("{} is {:g}, must be 0 or between {:g} and {:g} [m]", name, value, low, high));
  }
}

void requireRange(const char* name, double value, double low, double high, std::vector<std::string>& faults) {
  const bool is_inside = value >= low && value <= high;  // false for NaN
  if (!is_inside)
    faults.push_back(fmt::format("{} is {:g}, must be between {:g} and {:g} [m]", name, value, low, high));
}

}  // namespace

class OctomapNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    OctomapBuilder::Options options;
    StrictParameters parameters(getPrivateNodeHandle());
    parameters.read("resolution", options.resolution);
    parameters.read("max_range", options.max_range);
    parameters.read("map_range", options.map_range);
    parameters.read("fixed_frame", fixed_frame_);
    std::vector<std::string> found = parameters.faults();
    requireRange("resolution", options.resolution, 0.01, 10.0, found);
    requireRange("max_range", options.max_range, 1.0, 1000.0, found);
    requireRangeOrNone("map_range", options.map_range, 5.0, 10000.0, found);
    const std::string faults = joined(found);
    if (!faults.empty()) {
      NODELET_FATAL("%s", faults.c_str());
      throw std::invalid_argument(faults);
    }
    map_ = std::make_unique<OctomapBuilder>(options);
    listener_ = std::make_unique<tf2_ros::TransformListener>(tf_, getNodeHandle());
    publisher_ = getPrivateNodeHandle().advertise<sensor_msgs::PointCloud2>("cells", 1, true);
    // The newest alone: where the map cannot keep up with the sensor, clouds are left out, they do not pile up.
    subscriber_ = getNodeHandle().subscribe("points", 1, &OctomapNodelet::onCloud, this);
    timer_ = getNodeHandle().createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { publish(); });
  }

  void onCloud(const sensor_msgs::PointCloud2ConstPtr& cloud) {
    try {
      const auto transform = tf_.lookupTransform(fixed_frame_, cloud->header.frame_id, cloud->header.stamp);
      if (!map_->add(*cloud, tf2::transformToEigen(transform))) NODELET_WARN_THROTTLE(5.0, "a cloud cannot be read");
      stamp_ = cloud->header.stamp;
    } catch (const std::exception& error) {  // it would end the whole manager
      NODELET_WARN_THROTTLE(5.0, "a cloud is left out of the map: %s", error.what());
    }
  }

  /// The whole octree is walked: not where nobody asks for it.
  void publish() {
    if (publisher_.getNumSubscribers() == 0) return;
    std_msgs::Header header;
    header.frame_id = fixed_frame_;
    header.stamp = stamp_;
    if (!stamp_.isZero()) publisher_.publish(map_->occupiedCells(header));
  }

  std::string fixed_frame_ = "odom";
  std::unique_ptr<OctomapBuilder> map_;
  tf2_ros::Buffer tf_;
  std::unique_ptr<tf2_ros::TransformListener> listener_;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
  ros::WallTimer timer_;
  ros::Time stamp_;
};

}  // namespace donex

PLUGINLIB_EXPORT_CLASS(donex::OctomapNodelet, nodelet::Nodelet)
