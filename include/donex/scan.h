// One LiDAR scan as the core takes it, and its labels.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

namespace donex {

/// A scan P_k with the motion that belongs to it (paper, "Preliminaries").
/// Frames: `sensor` is the frame of the echoes, `base` the vehicle, `odom` the fixed frame (REP-105).
struct Scan {
  /// Time of the scan [s]; the echoes are given as if all of them were measured now.
  double stamp = 0.0;
  /// Echoes in the sensor frame [m]. A non-finite echo keeps its place and is never dynamic.
  std::vector<Eigen::Vector3f> echoes;
  /// 1 for each echo behind another one of the same beam. Empty: the detector looks for them itself, by direction, in
  /// echoes as they were measured; whoever moves echoes (de-skewing) looks before.
  std::vector<std::uint8_t> second_returns;
  /// Mounting: sensor coordinates to vehicle coordinates.
  Eigen::Isometry3d base_from_sensor = Eigen::Isometry3d::Identity();
  /// Ego motion at `stamp`: vehicle coordinates to odometry coordinates.
  Eigen::Isometry3d odom_from_base = Eigen::Isometry3d::Identity();

  Eigen::Isometry3d odomFromSensor() const { return odom_from_base * base_from_sensor; }
};

/// Labels of a scan, one entry per echo, in the order of the echoes.
struct EchoLabels {
  std::vector<std::uint8_t> dynamic;   ///< 1 dynamic, 0 static
  std::vector<std::uint8_t> observed;  ///< 1 where the grid had evidence to judge the echo

  /// Room for a scan's labels, whose values are left open.
  void resize(std::size_t echoes) {
    dynamic.resize(echoes);
    observed.resize(echoes);
  }
  void assign(std::size_t echoes) {
    dynamic.assign(echoes, 0);
    observed.assign(echoes, 0);
  }
};

}  // namespace donex
