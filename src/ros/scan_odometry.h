// Ego motion from the clouds themselves, for who has neither odometry nor tf.
#pragma once

#include <optional>
#include <vector>

#include "core/motion/lidar_odometry.h"
#include "donex/motion/ego_motion.h"

namespace donex {

/// LidarOdometry with a mounting for each sensor, and with the poses found so far as a track to de-skew by.
class ScanOdometry {
 public:
  ScanOdometry();

  /// Where the scan was measured. `echoes` in the sensor frame [m], as they were measured; `times` of each after the
  /// stamp [s], empty where there are none. Each sensor's mounting must stay until reset().
  const TrackedScan& locate(double stamp, const std::vector<Eigen::Vector3f>& echoes, const std::vector<float>& times,
                            const Eigen::Isometry3d& base_from_sensor);

  /// Of the scan located last: 1 for each echo that moves.
  void learn(const std::vector<std::uint8_t>& dynamic) { odometry_.learn(dynamic); }

  /// At the stamp of the scan located last.
  Eigen::Isometry3d odomFromBase() const { return odom_from_base_; }
  /// The poses of the vehicle; covers some tenths of a second beyond the newest scan, by constant velocity.
  const EgoMotion& track() const { return track_; }

  void reset();

 private:
  const std::vector<Eigen::Vector3f>& asFirstSensor(const std::vector<Eigen::Vector3f>& echoes,
                                                    const Eigen::Isometry3d& base_from_sensor);

  LidarOdometry odometry_;  // in the axes of the sensor that came first
  std::optional<Eigen::Isometry3d> base_from_first_;
  std::vector<Eigen::Vector3f> moved_;
  EgoMotion track_;
  Eigen::Isometry3d odom_from_base_ = Eigen::Isometry3d::Identity();
};

}  // namespace donex
