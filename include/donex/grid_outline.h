// Where a method's grid lies.
#pragma once

#include <Eigen/Geometry>

namespace donex {

/// An axis-aligned box of the grid in a frame of its own.
struct GridOutline {
  Eigen::Isometry3d odom_from_grid = Eigen::Isometry3d::Identity();
  Eigen::Vector3d min_corner = Eigen::Vector3d::Zero();  ///< grid frame [m]
  Eigen::Vector3d max_corner = Eigen::Vector3d::Zero();  ///< grid frame [m]
};

}  // namespace donex
