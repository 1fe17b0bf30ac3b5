// Two tracks of one vehicle, scan by scan: how far they part over a window, whatever frames they are told in.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

namespace donex {

/// One scan's place in both.
struct ComparedScan {
  double stamp = 0.0;                                       ///< [s]
  Eigen::Isometry3d given = Eigen::Isometry3d::Identity();  ///< the vehicle, by the odometry in question
  Eigen::Isometry3d found = Eigen::Isometry3d::Identity();  ///< the vehicle, by the scans alone
};

using Poses = std::vector<Eigen::Isometry3d>;

/// What is left between both motions over a window, along the ground: planar odometry is no wrong odometry.
struct TrackDifference {
  double way = 0.0;       ///< by the scans [m]
  double turn = 0.0;      ///< by the scans [rad]
  double distance = 0.0;  ///< between the ends, in x and y [m]
  double yaw = 0.0;       ///< [rad], signed

  /// Above 1 the difference harms the labels. An odometry that drifts by 1 % is none to complain of, nor is one whose
  /// poses have 3 cm of noise (docs/odometry.md: "Check of given odometry").
  double harm() const;
};

/// From scan `first` to scan `last`, by these poses of the odometry.
TrackDifference differenceBetween(const Poses& given, const Poses& found, std::size_t first, std::size_t last);

/// How long windows are.
struct ComparisonWindow {
  std::size_t scans = 20;        ///< at least
  double way = 8.0;              ///< at least, where most_scans reach so far [m]: slow errors need way to show
  std::size_t most_scans = 100;  ///< at most
};

/// The first scan of the window that ends with `last`; none where the track is too short for one.
bool windowBefore(const Poses& found, std::size_t last, const ComparisonWindow& window, std::size_t& first);

}  // namespace donex
