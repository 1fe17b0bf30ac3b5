// Rotations as vectors: the axis times the angle.
#pragma once

#include <Eigen/Geometry>

namespace donex {

/// `vector`: axis times angle [rad].
inline Eigen::Matrix3d rotationBy(const Eigen::Vector3d& vector) {
  const double angle = vector.norm();
  if (angle < 1e-15) return Eigen::Matrix3d::Identity();  // so short a vector tells no axis
  return Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix();
}

/// Axis times angle [rad], the shorter way round.
inline Eigen::Vector3d rotationVectorOf(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

}  // namespace donex
