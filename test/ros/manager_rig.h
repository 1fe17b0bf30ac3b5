// A nodelet manager with one classifier in it, and a test that talks to it from within the same process.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <nodelet/loader.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include "ros/pipeline_rig.h"

namespace donex::test {

/// Long enough for a machine that is busy with ten other builds: only what hangs takes as long [s].
constexpr double kHangs = 300.0;

/// Serves this process's callbacks, each as it comes, until `condition` holds; false when it does not in time.
inline bool waitFor(const std::function<bool()>& condition, double seconds = kHangs) {
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(seconds);
  while (ros::ok() && !condition()) {
    if (ros::WallTime::now() > deadline) return false;
    // Some conditions change without a callback: they are looked at this often [s].
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.002));
  }
  return ros::ok();
}

class ManagerTest : public ::testing::Test {
 protected:
  ManagerTest() : manager_(false), nh_(uniqueNamespace()) {
    clouds_ = nh_.advertise<sensor_msgs::PointCloud2>("points", 200);
    odometry_ = nh_.advertise<nav_msgs::Odometry>("odom", 2000);
    diagnostics_ = nh_.subscribe("/diagnostics", 50, &ManagerTest::onDiagnostics, this);
    transforms_.sendTransform(transformAt(0.0, "base_link", "lidar", 0.0, 1.7));
    setUpSmall(nodeName());
  }
  ~ManagerTest() override { manager_.clear(); }

  /// A small grid: quick to build. What an earlier run left behind must not count.
  static void setUpSmall(const std::string& node) {
    ros::param::del(node);
    for (const auto* name : {"x_min", "y_min"}) ros::param::set(node + "/" + name, -15.0);
    for (const auto* name : {"x_max", "y_max"}) ros::param::set(node + "/" + name, 15.0);
  }

  /// Loads the classifier and waits until it is connected.
  void load() {
    ASSERT_TRUE(tryLoad());
    connect(clouds_);
  }
  /// The same with a publisher's topic in the place of `points`, whose type may be another.
  void loadOn(const ros::Publisher& publisher) {
    const ros::M_string remappings{{nh_.resolveName("points"), publisher.getTopic()}};
    ASSERT_TRUE(manager_.load(nodeName(), "donex/DonexNodelet", remappings, {}));
    connect(publisher);
  }
  bool tryLoad() { return manager_.load(nodeName(), "donex/DonexNodelet", {}, {}); }

  void connect(const ros::Publisher& clouds) {
    labeled_ = nh_.subscribe("donex/labeled_points", 200, &ManagerTest::onLabeled, this);
    ASSERT_TRUE(waitFor([&] {
      return clouds.getNumSubscribers() == 1 && odometry_.getNumSubscribers() == 1 && labeled_.getNumPublishers() == 1;
    }));
  }

  std::string nodeName() const { return nh_.getNamespace() + "/donex"; }

  void sendOdometry(double stamp) { odometry_.publish(boost::make_shared<nav_msgs::Odometry>(odometryAt(stamp))); }
  void sendCloud(double stamp) { clouds_.publish(plainCloud(ring(), stamp)); }
  void send(double stamp) {
    sendOdometry(stamp);
    sendCloud(stamp);
  }
  /// The paper's rule alone: whatever is new is dynamic at once, also a single echo.
  static void usePapersRule(const std::string& node) {
    for (const auto* step :
         {"free_evidence", "careful_sight", "birth_age", "neighbourhood", "ground", "objects", "object_motion"})
      ros::param::set(node + "/" + step, false);
  }
  /// Where the lines of sight to the usual ring have been: new, unless the grid is.
  void sendInside(double stamp) {
    sendOdometry(stamp);
    clouds_.publish(plainCloud(ring(36, kInside), stamp));
  }
  bool waitForLabeled(std::size_t count) {
    return waitFor([&] { return received_.size() >= count; });
  }
  /// A figure of the classifier's diagnostics; empty before the first.
  std::string diagnostic(const std::string& key) const {
    const auto found = values_.find(key);
    return found == values_.end() ? "" : found->second;
  }
  bool waitForDiagnostic(const std::string& key, const std::string& value) {
    return waitFor([&] { return diagnostic(key) == value; });
  }

  nodelet::Loader manager_;
  ros::NodeHandle nh_;
  ros::Publisher clouds_, odometry_;
  ros::Subscriber labeled_, diagnostics_;
  tf2_ros::StaticTransformBroadcaster transforms_;
  std::vector<sensor_msgs::PointCloud2ConstPtr> received_;
  std::map<std::string, std::string> values_;
  std::string status_;

 private:
  static std::string uniqueNamespace() {
    static std::atomic<int> count{0};
    return "/test_" + std::to_string(++count);
  }
  void onLabeled(const sensor_msgs::PointCloud2ConstPtr& cloud) { received_.push_back(cloud); }
  void onDiagnostics(const diagnostic_msgs::DiagnosticArrayConstPtr& array) {
    for (const auto& status : array->status) {
      if (status.name != nodeName().substr(1) + ": classifier") continue;
      status_ = status.message;
      for (const auto& value : status.values) values_[value.key] = value.value;
    }
  }
};

/// The label of an echo of a labelled cloud.
inline int labelOf(const sensor_msgs::PointCloud2& cloud, const std::string& name, std::size_t echo) {
  for (const auto& field : cloud.fields) {
    if (field.name == name) return cloud.data[echo * cloud.point_step + field.offset];
  }
  ADD_FAILURE() << "no field " << name;
  return -1;
}

}  // namespace donex::test
