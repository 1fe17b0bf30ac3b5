#include "ros/octomap_node.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <ros/ros.h>
#include <tf2_eigen/tf2_eigen.h>

#include "ros/parameters.h"
#include "ros/strict_parameters.h"

namespace donex {
namespace {

constexpr double kPublishPeriod = 1.0;                 // [s]
constexpr double kLogPeriod = 5.0;                     // between messages of one kind [s]
constexpr std::chrono::milliseconds kRetryPeriod(20);  // clouds that wait for tf are looked at this often

/// A cloud waits for tf, which may come later than it does, and for the map to be done with newer ones [s].
constexpr double kLongestWait = 1.0;

/// A queue of roscpp's that is full drops silently. Ours is emptied at once, into one that tells.
constexpr std::uint32_t kUnbounded = 0;

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

OctomapNode::Settings OctomapNode::readSettings(const ros::NodeHandle& pnh) {
  Settings settings;
  StrictParameters parameters(pnh);
  parameters.read("resolution", settings.map.resolution);
  parameters.read("max_range", settings.map.max_range);
  parameters.read("map_range", settings.map.map_range);
  parameters.read("fixed_frame", settings.fixed_frame);
  std::vector<std::string> faults = parameters.faults();
  requireRange("resolution", settings.map.resolution, 0.01, 10.0, faults);
  requireRange("max_range", settings.map.max_range, 1.0, 1000.0, faults);
  const double reach = OctomapBuilder::kReach * settings.map.resolution;
  if (settings.map.max_range > reach) {
    faults.push_back(fmt::format("max_range is {:g}, with this resolution it must be {:g} [m] at most",
                                 settings.map.max_range, reach));
  }
  requireRangeOrNone("map_range", settings.map.map_range, 5.0, 10000.0, faults);
  if (!faults.empty()) throw std::invalid_argument(joined(faults));
  return settings;
}

OctomapNode::OctomapNode(const ros::NodeHandle& nh, const ros::NodeHandle& pnh)
    : settings_(readSettings(pnh)), map_(settings_.map), tf_subscription_(tf_, nh) {
  ros::NodeHandle topics(nh), own_topics(pnh);
  publisher_ = own_topics.advertise<sensor_msgs::PointCloud2>("cells", 1, true);
  subscriber_ = topics.subscribe("points", kUnbounded, &OctomapNode::onCloud, this);
  thread_ = std::thread([this] { run(); });
}

OctomapNode::~OctomapNode() {
  subscriber_.shutdown();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void OctomapNode::onCloud(const sensor_msgs::PointCloud2ConstPtr& cloud) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const ros::WallTime now = ros::WallTime::now();
  ++arrived_;
  waiting_.push_back({now, cloud});
  giveUpTheLate(now);
  wake_.notify_all();
}

void OctomapNode::giveUpTheLate(const ros::WallTime& now) {
  while ((now - waiting_.front().since).toSec() > kLongestWait) {
    const std_msgs::Header& header = waiting_.front().cloud->header;
    std::string why;
    const bool is_reached = tf_.canTransform(settings_.fixed_frame, header.frame_id, header.stamp, &why);
    if (!is_reached) tf_subscription_.transformIsMissing();
    leaveOut(is_reached ? "the map is busy with newer ones" : why);
    waiting_.pop_front();
  }
}

void OctomapNode::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stop_) {
    lock.unlock();
    const bool is_busy = addNewest();
    publish();
    lock.lock();
    if (!is_busy && !stop_) wake_.wait_for(lock, kRetryPeriod);
  }
}

/// Of those that tf reaches: a map that cannot keep up with the sensor shows the present. False where there is none.
bool OctomapNode::addNewest() {
  const auto is_reached = [this](const Waiting& waiting) {
    const std_msgs::Header& header = waiting.cloud->header;
    return tf_.canTransform(settings_.fixed_frame, header.frame_id, header.stamp);
  };
  std::unique_lock<std::mutex> lock(mutex_);
  const auto newest = std::find_if(waiting_.rbegin(), waiting_.rend(), is_reached);
  if (newest == waiting_.rend()) return false;
  const sensor_msgs::PointCloud2ConstPtr cloud = newest->cloud;
  waiting_.erase(std::prev(newest.base()));
  lock.unlock();
  add(*cloud);
  return true;
}

void OctomapNode::add(const sensor_msgs::PointCloud2& cloud) {
  std::string fault;
  try {
    const auto transform = tf_.lookupTransform(settings_.fixed_frame, cloud.header.frame_id, cloud.header.stamp);
    if (!map_.add(cloud, tf2::transformToEigen(transform))) fault = "it cannot be read";
  } catch (const std::exception& error) {  // it would end the whole manager
    fault = error.what();
  }
  if (fault.empty()) {
    stamp_ = cloud.header.stamp;
    return;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  leaveOut(fault);
}

/// With the mutex.
void OctomapNode::leaveOut(const std::string& why) {
  ++left_out_;
  ROS_WARN_STREAM_THROTTLE_NAMED(
      kLogPeriod, "donex", left_out_ << " of " << arrived_ << " clouds are left out of the map, the last: " << why);
}

/// The whole octree is walked: not where nobody asks for it.
void OctomapNode::publish() {
  const ros::WallTime now = ros::WallTime::now();
  if (now < publish_at_ || publisher_.getNumSubscribers() == 0 || stamp_.isZero()) return;
  publish_at_ = now + ros::WallDuration(kPublishPeriod);
  std_msgs::Header header;
  header.frame_id = settings_.fixed_frame;
  header.stamp = stamp_;
  publisher_.publish(map_.occupiedCells(header));
}

}  // namespace donex
