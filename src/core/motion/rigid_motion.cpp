#include "donex/motion/rigid_motion.h"

#include <cmath>

namespace donex {
namespace {

/// Below this angle [rad] the closed forms lose digits and their series are exact to rounding.
constexpr double kSmallAngle = 1e-4;
constexpr double kNormTolerance = 0.01;

struct ExponentialFactors {
  double sine;    // (1 - cos a) / a^2
  double linear;  // (a - sin a) / a^3
};

ExponentialFactors exponentialFactors(double angle) {
  const double square = angle * angle;
  if (angle < kSmallAngle) return {0.5 - square / 24.0, 1.0 / 6.0 - square / 120.0};
  return {(1.0 - std::cos(angle)) / square, (angle - std::sin(angle)) / (square * angle)};
}

Eigen::Isometry3d makePose(const Eigen::Vector3d& position, const Eigen::Quaterniond& unit_rotation) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = unit_rotation.toRotationMatrix();
  pose.translation() = position;
  return pose;
}

Eigen::Quaterniond rotationOf(const Eigen::Isometry3d& pose) {
  return Eigen::Quaterniond(Eigen::Matrix3d(pose.linear()));
}

}  // namespace

const char* describe(MotionFault fault) {
  switch (fault) {
    case MotionFault::kNone: return "no fault";
    case MotionFault::kNoSamples: return "no odometry yet";
    case MotionFault::kTooOld: return "older than the oldest odometry kept";
    case MotionFault::kNotYetCovered: return "odometry does not reach this time yet";
    case MotionFault::kGapTooLong: return "gap in the odometry too long to interpolate";
    case MotionFault::kNonFinite: return "NaN or infinity";
    case MotionFault::kNonUnitQuaternion: return "quaternion is not of unit length";
    case MotionFault::kSizeMismatch: return "as many times as echoes are needed";
  }
  return "unknown fault";
}

Eigen::Isometry3d integrateTwist(const Twist& twist, double duration) {
  const Eigen::Vector3d rotation = twist.angular * duration;
  const Eigen::Vector3d shift = twist.linear * duration;
  const double angle = rotation.norm();
  const auto factors = exponentialFactors(angle);
  const Eigen::Vector3d turned = rotation.cross(shift);
  const Eigen::Vector3d position = shift + factors.sine * turned + factors.linear * rotation.cross(turned);
  const bool turns = angle > 0.0;
  if (!turns) return makePose(position, Eigen::Quaterniond::Identity());
  return makePose(position, Eigen::Quaterniond(Eigen::AngleAxisd(angle, rotation / angle)));
}

Eigen::Isometry3d interpolate(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, double fraction) {
  const Eigen::Vector3d position = from.translation() + fraction * (to.translation() - from.translation());
  return makePose(position, rotationOf(from).slerp(fraction, rotationOf(to)).normalized());
}

Eigen::Isometry3d orthonormalised(const Eigen::Isometry3d& pose) {
  return makePose(pose.translation(), rotationOf(pose).normalized());
}

MotionResult<Eigen::Isometry3d> checkedPose(const Eigen::Vector3d& position, const Eigen::Quaterniond& rotation) {
  if (!position.allFinite() || !rotation.coeffs().allFinite()) return MotionFault::kNonFinite;
  const bool is_rotation = std::abs(rotation.norm() - 1.0) <= kNormTolerance;
  if (!is_rotation) return MotionFault::kNonUnitQuaternion;
  return makePose(position, rotation.normalized());
}

}  // namespace donex
