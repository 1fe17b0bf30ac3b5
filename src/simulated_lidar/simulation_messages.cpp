#include "simulated_lidar/simulation_messages.h"

#include <cstring>

#include <boost/make_shared.hpp>
#include <tf2_eigen/tf2_eigen.h>

#include "ros/cloud_fields.h"

namespace donex {
namespace {

/// One echo as it lies in the cloud.
struct Row {
  float x, y, z;
  float intensity;
  float time;
  std::uint32_t label;
  std::uint16_t ring;
  std::uint16_t padding;
};
static_assert(sizeof(Row) == 28, "the fields below count on it");

void addFields(sensor_msgs::PointCloud2& cloud) {
  using Field = sensor_msgs::PointField;
  addField(cloud, "x", offsetof(Row, x), Field::FLOAT32);
  addField(cloud, "y", offsetof(Row, y), Field::FLOAT32);
  addField(cloud, "z", offsetof(Row, z), Field::FLOAT32);
  addField(cloud, "intensity", offsetof(Row, intensity), Field::FLOAT32);
  addField(cloud, "time", offsetof(Row, time), Field::FLOAT32);
  addField(cloud, "label", offsetof(Row, label), Field::UINT32);
  addField(cloud, "ring", offsetof(Row, ring), Field::UINT16);
}

}  // namespace

sensor_msgs::PointCloud2Ptr toCloud(const simulation::SimulatedScan& scan, const SimulationFrames& frames) {
  std_msgs::Header header;
  header.stamp = ros::Time(scan.stamp);
  header.frame_id = frames.of(scan.sensor);
  auto cloud = makeCloud(header, scan.echoes.size(), sizeof(Row));
  cloud->is_dense = true;
  addFields(*cloud);
  for (std::size_t i = 0; i < scan.echoes.size(); ++i) {
    const simulation::SimulatedEcho& echo = scan.echoes[i];
    const Row row{echo.position.x(), echo.position.y(), echo.position.z(), echo.intensity,
                  echo.time,         scan.labels[i],    echo.ring,         0};
    std::memcpy(cloud->data.data() + i * sizeof(Row), &row, sizeof(Row));
  }
  return cloud;
}

nav_msgs::OdometryPtr toOdometry(const OdometrySample& sample, const SimulationFrames& frames) {
  auto message = boost::make_shared<nav_msgs::Odometry>();
  message->header.stamp = ros::Time(sample.stamp);
  message->header.frame_id = frames.odom;
  message->child_frame_id = frames.base;
  message->pose.pose = tf2::toMsg(sample.odom_from_base);
  tf2::toMsg(sample.twist.linear, message->twist.twist.linear);
  tf2::toMsg(sample.twist.angular, message->twist.twist.angular);
  return message;
}

geometry_msgs::TransformStamped toTransform(const OdometrySample& sample, const SimulationFrames& frames) {
  geometry_msgs::TransformStamped message = tf2::eigenToTransform(sample.odom_from_base);
  message.header.stamp = ros::Time(sample.stamp);
  message.header.frame_id = frames.odom;
  message.child_frame_id = frames.base;
  return message;
}

geometry_msgs::TransformStamped mountingOf(const Eigen::Isometry3d& base_from_sensor, double stamp,
                                           const SimulationFrames& frames) {
  geometry_msgs::TransformStamped message = tf2::eigenToTransform(base_from_sensor);
  message.header.stamp = ros::Time(stamp);
  message.header.frame_id = frames.base;
  message.child_frame_id = frames.sensor;
  return message;
}

std::vector<geometry_msgs::TransformStamped> mountingsOf(const simulation::Simulator& simulator, double stamp,
                                                         const SimulationFrames& frames) {
  std::vector<geometry_msgs::TransformStamped> mountings;
  for (std::size_t i = 0; i < simulator.sensorCount(); ++i) {
    mountings.push_back(mountingOf(simulator.baseFromSensor(i), stamp, frames));
    mountings.back().child_frame_id = frames.of(simulator.sensorName(i));
  }
  return mountings;
}

}  // namespace donex
