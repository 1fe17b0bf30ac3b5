// A rigid pose in the form odometry messages have it.
#pragma once

#include <optional>
#include <string>

#include <Eigen/Geometry>

namespace donex {

/// Position [m] and unit quaternion. The quaternion is a fixed point of normalising, so that a pose that
/// travels through a nav_msgs/Odometry message comes back bit for bit: the same labels from both.
struct Pose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();

  /// The nearest such pose of a transform that is rigid up to rounding.
  static Pose fromIsometry(const Eigen::Isometry3d& transform);
  Eigen::Isometry3d isometry() const;
};

/// Position linear, rotation slerp; `fraction` 0 gives `from` itself, 1 gives `to` itself.
Pose interpolate(const Pose& from, const Pose& to, double fraction);

using PoseMatrix = Eigen::Matrix<double, 3, 4>;

/// Why the 3x4 matrix is not a rigid transform (non-finite, not orthonormal within 1e-3, mirrored); empty where it is
/// one.
std::optional<std::string> faultOfPose(const PoseMatrix& matrix);

/// A line of poses.txt, with its end: the twelve numbers of the matrix, row by row, to the last digit.
std::string poseLine(const Pose& pose);

/// Re-orthonormalised. The matrix must have no fault.
Pose poseFromMatrix(const PoseMatrix& matrix);

}  // namespace donex
