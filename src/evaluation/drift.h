// How far an odometry goes astray, as the KITTI benchmark measures it: over pieces of the way.
#pragma once

#include <vector>

#include <Eigen/Geometry>

namespace donex {

/// Means over all pieces of one length, each beginning at a scan.
struct Drift {
  double length = 0.0;       ///< of a piece [m]
  std::size_t pieces = 0;    ///< 0: the drive is shorter than one
  double translation = 0.0;  ///< error of the end, as a share of the way
  double rotation = 0.0;     ///< error of the end [rad]
};

/// Of poses scan by scan, in frames of their own each; both as long as one another.
Drift driftOver(const std::vector<Eigen::Isometry3d>& estimated, const std::vector<Eigen::Isometry3d>& reference,
                double length);

}  // namespace donex
