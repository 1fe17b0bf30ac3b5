// A pipeline with everything it tells written down, and short ways to feed it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <tf2/buffer_core.h>

#include "ros/cloud_builder.h"
#include "ros/pipeline.h"

namespace donex::test {

/// Odometry that moves straight along x at `speed` [m/s] through x = 0 at 100 s.
inline nav_msgs::Odometry odometryAt(double stamp, double speed = 0.0) {
  nav_msgs::Odometry odometry;
  odometry.header.stamp.fromSec(stamp);
  odometry.header.frame_id = "odom";
  odometry.child_frame_id = "base_link";
  odometry.pose.pose.position.x = speed * (stamp - 100.0);
  odometry.pose.pose.orientation.w = 1.0;
  odometry.twist.twist.linear.x = speed;
  return odometry;
}

inline geometry_msgs::TransformStamped transformAt(double stamp, const std::string& parent, const std::string& child,
                                                   double x, double z = 0.0) {
  geometry_msgs::TransformStamped transform;
  transform.header.stamp.fromSec(stamp);
  transform.header.frame_id = parent;
  transform.child_frame_id = child;
  transform.transform.translation.x = x;
  transform.transform.translation.z = z;
  transform.transform.rotation.w = 1.0;
  return transform;
}

/// A radius that the lines of sight to ring() pass [m].
constexpr float kInside = 5.13F;

/// Echoes on a ring around the sensor, `radius` [m]. A narrower ring lies on the lines of sight to the echoes of a
/// wider one: where the wider one was seen for a while, the narrower one is new.
inline std::vector<Eigen::Vector3f> ring(std::size_t echoes = 36, float radius = 10.0F) {
  std::vector<Eigen::Vector3f> all;
  for (std::size_t i = 0; i < echoes; ++i) {
    // A little turned: no echo lies on a voxel's border.
    const float angle = 0.03F + 6.2831853F * static_cast<float>(i) / static_cast<float>(echoes);
    all.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.05F * radius);
  }
  return all;
}

/// A small grid: quick to build and to forget.
inline Config smallConfig(OdometrySource source = OdometrySource::kPose) {
  Config config;
  config.region = {-15.0, 15.0, -15.0, 15.0, -1.0, 4.0};
  config.motion.source = source;
  return config;
}

struct Labeled {
  double stamp, last_echo;
  Eigen::Isometry3d odom_from_base, base_from_sensor, odom_from_world;
  std::vector<Eigen::Vector3f> echoes;
  EchoLabels labels;
  sensor_msgs::PointCloud2ConstPtr published;
};

class PipelineRig {
 public:
  /// The sensor sits 1.7 m above base_link unless `mounted` is false.
  explicit PipelineRig(const Config& config = smallConfig(), bool mounted = true) : pipeline(config, tf, events()) {
    if (mounted) tf.setTransform(transformAt(0.0, "base_link", "lidar", 0.0, 1.7), "test", true);
  }

  void cloud(double stamp, double now) { pipeline.addCloud(plainCloud(ring(), stamp), now); }
  void cloud(double stamp) { cloud(stamp, stamp); }
  void odometry(double stamp, double speed = 0.0) { pipeline.addOdometry(odometryAt(stamp, speed)); }
  void run(double now) {
    while (pipeline.step(now)) {
    }
  }

  std::size_t dropped(DropReason reason) const { return pipeline.counts().dropped.of(reason); }
  std::size_t refused(OdometryRefusal refusal) const { return pipeline.counts().refused.of(refusal); }
  std::vector<double> stamps() const {
    std::vector<double> all;
    for (const Labeled& scan : labeled) all.push_back(scan.stamp);
    return all;
  }

  tf2::BufferCore tf;
  std::vector<Labeled> labeled;
  std::vector<std::string> drops, refusals, forgotten, strange_times, not_deskewed, remarks, completed, sensors;
  Pipeline pipeline;

 private:
  PipelineEvents events() {
    PipelineEvents events;
    events.labeled = [this](const LabeledScan& scan) {
      labeled.push_back({scan.cloud->header.stamp.toSec(), scan.last_echo, scan.scan.odom_from_base,
                         scan.scan.base_from_sensor, scan.odom_from_world, scan.scan.echoes, scan.labels,
                         labelCloud(*scan.cloud, scan.layout, scan.labels)});
    };
    events.dropped = [this](DropReason, const std::string& text) { drops.push_back(text); };
    events.refused = [this](OdometryRefusal, const std::string& text) { refusals.push_back(text); };
    events.forgotten = [this](const std::string& text) { forgotten.push_back(text); };
    events.strange_times = [this](const std::string& text) { strange_times.push_back(text); };
    events.not_deskewed = [this](const std::string& text) { not_deskewed.push_back(text); };
    events.odometry_completed = [this](const std::string& text) { completed.push_back(text); };
    events.sensor_measured = [this](const std::string& text) { sensors.push_back(text); };
    events.remarked = [this](CloudRemark, const std::string& text) { remarks.push_back(text); };
    return events;
  }
};

}  // namespace donex::test
