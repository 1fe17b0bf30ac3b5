// Odometry that jumps, told by itself alone and at once: before the scan is judged by it.
#pragma once

#include <Eigen/Geometry>

namespace donex {

/// Compares each step with the one before. Scans seldom enough apart tell nothing.
class OdometryJump {
 public:
  struct Options {
    double tolerance = 0.3;      ///< noise of poses of 3 cm stays below [m]
    double acceleration = 12.0;  ///< no vehicle on wheels brakes harder [m/s^2]
    double longest_step = 1.0;   ///< over a longer one nothing is predicted [s]
  };

  OdometryJump() = default;
  explicit OdometryJump(const Options& options) : options_(options) {}

  /// Where the vehicle is at the stamp of the next scan [s]. How far that is from where it should be [m], if that is a
  /// jump; else 0.
  double follow(double stamp, const Eigen::Isometry3d& odom_from_base);

  void reset() { has_pose_ = has_step_ = false; }

 private:
  Options options_;
  bool has_pose_ = false, has_step_ = false;
  double stamp_ = 0.0, step_time_ = 0.0;  // [s]
  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity(), step_ = Eigen::Isometry3d::Identity();
};

}  // namespace donex
