// Odometry at a rate of its own along the poses of scans.
#pragma once

#include <vector>

#include "donex/motion/rigid_motion.h"
#include "io/pose.h"

namespace donex {

struct OdometryRhythm {
  /// Messages a second [1/s], above 0, rounded: every time between two scans is divided into equal parts, so that
  /// there is always one message at a scan's own stamp.
  double rate = 10.0;
  /// Moves all messages against the scans [s]: then every scan's pose has to be interpolated.
  double offset = 0.0;
};

/// Ego motion as an odometry message holds it.
struct OdometryPoint {
  double stamp = 0.0;  ///< [s]
  Pose odom_from_base;
  Twist twist;  ///< in base axes
};

/// Position linear, rotation slerp between the poses; beyond the ends the motion goes on. Sorted by stamp. At a pose's
/// own stamp the pose is bit for bit the one given. `stamps` (rising) and `poses` are of equal length, not empty.
std::vector<OdometryPoint> odometryAlong(const std::vector<double>& stamps, const std::vector<Pose>& poses,
                                         const OdometryRhythm& rhythm);

}  // namespace donex
