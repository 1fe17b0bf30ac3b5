// What the simulated vehicle sends.
#pragma once

#include <string>
#include <vector>

#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/PointCloud2.h>

#include "simulation/simulator.h"

namespace donex {

struct SimulationFrames {
  std::string odom = "odom";
  std::string base = "base_link";
  std::string sensor = "velodyne";  ///< of the only one; those of a rig are called as the rig does

  /// Of a sensor by its name in the rig.
  const std::string& of(const std::string& name) const { return name.empty() ? sensor : name; }
};

/// Not organised: x, y, z, intensity, time (FLOAT32), ring (UINT16) as Velodyne's drivers write them, and the ground
/// truth as `label` (UINT32, see SimulatedScan::labels).
sensor_msgs::PointCloud2Ptr toCloud(const simulation::SimulatedScan& scan, const SimulationFrames& frames);

/// Throws std::runtime_error where a stamp lies before the epoch, which ros::Time cannot hold: odometry begins 0.1 s
/// before the scene does.
nav_msgs::OdometryPtr toOdometry(const OdometrySample& sample, const SimulationFrames& frames);

/// odom -> base, as the odometry has it.
geometry_msgs::TransformStamped toTransform(const OdometrySample& sample, const SimulationFrames& frames);

/// base -> sensor.
geometry_msgs::TransformStamped mountingOf(const Eigen::Isometry3d& base_from_sensor, double stamp,
                                           const SimulationFrames& frames);

/// The same of every sensor of the rig.
std::vector<geometry_msgs::TransformStamped> mountingsOf(const simulation::Simulator& simulator, double stamp,
                                                         const SimulationFrames& frames);

}  // namespace donex
