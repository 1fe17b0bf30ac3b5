#include "simulation/odometry_error.h"

namespace donex::simulation {
namespace {

Eigen::Isometry3d turnedAndMoved(const Eigen::Isometry3d& pose, const Eigen::Vector3d& rotation,
                                 const Eigen::Vector3d& translation) {
  Eigen::Isometry3d result = pose;
  if (rotation.norm() > 0.0) result.rotate(Eigen::AngleAxisd(rotation.norm(), rotation.normalized()));
  result.pretranslate(translation);
  return result;
}

}  // namespace

OdometryError::OdometryError(const OdometryOptions& options, std::uint64_t seed) : options_(options), random_(seed) {
  length_error_ = options.drift * (random_.chance(0.5) ? 1.0 : -1.0);
  yaw_error_ = options.yaw_drift * (random_.chance(0.5) ? 1.0 : -1.0);
}

Eigen::Vector3d OdometryError::noise(double deviation) {
  const double x = random_.gaussian();
  const double y = random_.gaussian();
  const double z = random_.gaussian();
  return deviation * Eigen::Vector3d(x, y, z);
}

OdometrySample OdometryError::report(double stamp, const Eigen::Isometry3d& odom_from_base, const Twist& twist) {
  if (!started_) {
    true_pose_ = drifted_ = odom_from_base;
    started_ = true;
  }
  Eigen::Isometry3d step = true_pose_.inverse() * odom_from_base;
  const double way = step.translation().norm();
  step.translation() *= 1.0 + length_error_;
  step.rotate(Eigen::AngleAxisd(yaw_error_ * way, Eigen::Vector3d::UnitZ()));
  true_pose_ = odom_from_base;
  drifted_ = orthonormalised(drifted_ * step);

  OdometrySample sample;
  sample.stamp = stamp + options_.stamp_offset;
  const Eigen::Vector3d rotation = noise(options_.rotation_noise);
  sample.odom_from_base = turnedAndMoved(drifted_, rotation, noise(options_.position_noise));
  sample.twist.linear = (1.0 + length_error_) * twist.linear + noise(options_.linear_noise);
  sample.twist.angular = twist.angular + noise(options_.angular_noise);
  return sample;
}

}  // namespace donex::simulation
