#include "simulated_lidar/simulated_lidar.h"

#include <algorithm>
#include <condition_variable>
#include <future>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <ros/ros.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include "ros/parameters.h"
#include "ros/strict_parameters.h"
#include "simulated_lidar/simulation_messages.h"

namespace donex {
namespace {

using simulation::OptionInfo;
using simulation::SimulatedScan;
using simulation::Simulator;
using simulation::SimulatorOptions;

struct Settings {
  std::string scene = "street";
  SimulatorOptions options;
  SimulationFrames frames;
  bool publish_tf = true;
};

/// Reads the options by their names; the stamps are the clock's, so there is no start_stamp.
struct OptionReader {
  StrictParameters& parameters;

  template <class Number>
  void operator()(const OptionInfo& info, Number& value, Number, Number) {
    if (std::string(info.name) != "start_stamp") parameters.read(info.name, value);
  }
  void operator()(const OptionInfo& info, std::string& value, const std::vector<std::string>&) {
    parameters.read(info.name, value);
  }
  void operator()(const OptionInfo& info, bool& value) { parameters.read(info.name, value); }
};

Settings readSettings(const ros::NodeHandle& pnh) {
  Settings settings;
  settings.options.duration = 0.0;
  StrictParameters parameters(pnh);
  parameters.read("scene", settings.scene);
  parameters.read("odom_frame", settings.frames.odom);
  parameters.read("base_frame", settings.frames.base);
  parameters.read("sensor_frame", settings.frames.sensor);
  parameters.read("publish_tf", settings.publish_tf);
  visitOptions(settings.options, OptionReader{parameters});

  std::vector<std::string> faults = parameters.faults();
  for (const std::string& fault : simulation::faultsOf(settings.scene, settings.options)) faults.push_back(fault);
  const bool has_rig = settings.options.rig != SimulatorOptions().rig;
  if (has_rig && pnh.hasParam("sensor_frame")) {
    faults.emplace_back("sensor_frame is for a single sensor: the frames of a rig are called as its sensors");
  }
  if (faults.empty()) return settings;
  throw std::invalid_argument("bad parameters in " + pnh.getNamespace() + ": " + joined(faults));
}

/// A scan and all that is sent with it, ready to send.
struct Sending {
  double due = 0.0;  // [s]
  sensor_msgs::PointCloud2Ptr cloud;
  std::vector<OdometrySample> odometry;
};

/// Of all sensors, in all parts: parts of it leave no time to measure the next turn between them.
using Turn = std::vector<Sending>;

}  // namespace

class SimulatedLidar::Implementation {
 public:
  Implementation(ros::NodeHandle nh, Settings settings);
  ~Implementation();

 private:
  void run();
  void play();
  Turn nextTurn();
  bool send(const Sending& sending);
  void tellMountings(double stamp);
  void sendOdometry(const OdometrySample& sample);
  bool waitUntil(double stamp);

  Settings settings_;
  std::unique_ptr<Simulator> simulator_;
  std::vector<geometry_msgs::TransformStamped> mountings_;
  double told_ = 0.0;  // when they were sent [s]
  ros::Publisher cloud_publisher_, odometry_publisher_;
  tf2_ros::StaticTransformBroadcaster mounting_broadcaster_;
  tf2_ros::TransformBroadcaster broadcaster_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stop_ = false;
  std::thread thread_;
};

SimulatedLidar::Implementation::Implementation(ros::NodeHandle nh, Settings settings) : settings_(std::move(settings)) {
  constexpr std::uint32_t kClouds = 10;
  constexpr std::uint32_t kOdometry = 1000;
  cloud_publisher_ = nh.advertise<sensor_msgs::PointCloud2>("points", kClouds);
  odometry_publisher_ = nh.advertise<nav_msgs::Odometry>("odom", kOdometry);
  thread_ = std::thread([this] { run(); });
}

SimulatedLidar::Implementation::~Implementation() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void SimulatedLidar::Implementation::run() {
  try {
    play();
  } catch (const std::exception& error) {
    ROS_FATAL("simulated LiDAR: %s", error.what());  // an exception out of a thread would end the whole manager
  }
}

/// While one turn is sent, the next is measured.
void SimulatedLidar::Implementation::play() {
  // Begins late enough for the first scan to be measured in time.
  constexpr double kHeadStart = 0.5;  // [s]
  settings_.options.start_stamp = ros::WallTime::now().toSec() + kHeadStart;
  simulator_ = std::make_unique<Simulator>(settings_.scene, settings_.options);
  mountings_ = mountingsOf(*simulator_, settings_.options.start_stamp, settings_.frames);
  mounting_broadcaster_.sendTransform(mountings_);
  ROS_INFO("simulated LiDAR: %s, %d beams: %s", settings_.scene.c_str(), simulator_->beams(),
           simulation::sceneMeaning(settings_.scene).c_str());

  const auto measure = [this] { return std::async(std::launch::async, [this] { return nextTurn(); }); };
  auto coming = measure();
  for (Turn turn = coming.get(); !turn.empty(); turn = coming.get()) {
    tellMountings(turn.front().due);
    coming = measure();
    for (const Sending& sending : turn) {
      if (!send(sending)) return;
    }
  }
  ROS_INFO("simulated LiDAR: %s is over after %g s", settings_.scene.c_str(), settings_.options.duration);
}

/// roscpp can lose a latched message for a node that subscribes at the moment of publishing: it is sent again.
void SimulatedLidar::Implementation::tellMountings(double stamp) {
  constexpr double kTellAgain = 1.0;  // [s]
  if (stamp < told_ + kTellAgain) return;
  mounting_broadcaster_.sendTransform(mountings_);
  told_ = stamp;
}

/// Empty when the drive is over.
Turn SimulatedLidar::Implementation::nextTurn() {
  Turn turn;
  SimulatedScan scan;
  while (turn.size() < simulator_->scansPerTurn() && simulator_->next(scan)) {
    turn.push_back({scan.sent, toCloud(scan, settings_.frames), std::move(scan.odometry)});
  }
  return turn;
}

/// False when the node ends.
bool SimulatedLidar::Implementation::send(const Sending& sending) {
  const auto is_before = [](const OdometrySample& sample, double stamp) { return sample.stamp < stamp; };
  const auto after = std::lower_bound(sending.odometry.begin(), sending.odometry.end(), sending.due, is_before);
  for (auto sample = sending.odometry.begin(); sample != after; ++sample) {
    if (!waitUntil(sample->stamp)) return false;
    sendOdometry(*sample);
  }
  if (!waitUntil(sending.due)) return false;
  cloud_publisher_.publish(sending.cloud);
  std::for_each(after, sending.odometry.end(), [this](const OdometrySample& sample) { sendOdometry(sample); });
  return true;
}

void SimulatedLidar::Implementation::sendOdometry(const OdometrySample& sample) {
  odometry_publisher_.publish(toOdometry(sample, settings_.frames));
  if (settings_.publish_tf) broadcaster_.sendTransform(toTransform(sample, settings_.frames));
}

/// False when the node ends. A machine that is too slow is not waited for: it sends as fast as it can.
bool SimulatedLidar::Implementation::waitUntil(double stamp) {
  const double remaining = stamp - ros::WallTime::now().toSec();
  std::unique_lock<std::mutex> lock(mutex_);
  return !wake_.wait_for(lock, std::chrono::duration<double>(remaining), [this] { return stop_; });
}

SimulatedLidar::SimulatedLidar(const ros::NodeHandle& nh, const ros::NodeHandle& pnh)
    : implementation_(std::make_unique<Implementation>(nh, readSettings(pnh))) {}

SimulatedLidar::~SimulatedLidar() = default;

}  // namespace donex
