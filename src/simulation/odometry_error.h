// What a vehicle believes of its own motion.
#pragma once

#include "simulation/random.h"
#include "simulation/simulator.h"

namespace donex::simulation {

/// Turns true motion into reported odometry: drift that accumulates with the way, white noise on top.
class OdometryError {
 public:
  OdometryError(const OdometryOptions& options, std::uint64_t seed);

  /// Called for rising times, in steps of one sample. `stamp` without the offset.
  OdometrySample report(double stamp, const Eigen::Isometry3d& odom_from_base, const Twist& twist);

 private:
  Eigen::Vector3d noise(double deviation);

  OdometryOptions options_;
  Random random_;
  double length_error_;
  double yaw_error_;
  bool started_ = false;
  Eigen::Isometry3d true_pose_ = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d drifted_ = Eigen::Isometry3d::Identity();
};

}  // namespace donex::simulation
