// Ego motion on somebody else's word: its jumps are told, and where it never leaves a plane, the clouds complete it.
#pragma once

#include <cstdint>
#include <vector>

#include "core/motion/odometry_jump.h"
#include "core/motion/planar_completion.h"
#include "donex/config.h"
#include "donex/scan.h"
#include "ros/motion_source.h"

namespace donex {

/// Takes scans in the order in which they are judged. Leaves motion alone that the clouds tell, or that there is none.
class GivenOdometry {
 public:
  explicit GivenOdometry(const Config& config);

  /// How far the odometry jumped before this scan [m]: what a grid remembers lies elsewhere then. 0 without a jump, and
  /// where nobody is to know (odometry_check, methods that take a whole drive).
  double jumpBefore(const Scan& scan, const ScanMotion& motion, OdometrySource source);

  /// Gives the scan, de-skewed, its height, roll and pitch. Whether it was for the clouds to tell them.
  bool complete(Scan& scan, const ScanMotion& motion, OdometrySource source);

  /// Of the scan completed last: 1 for each echo that moves.
  void learn(const std::vector<std::uint8_t>& dynamic);

  /// From the world as that scan has it, in which the vehicle tilts; the identity where nothing was completed.
  const Eigen::Isometry3d& odomFromWorld() const { return odom_from_world_; }

  /// The grid is empty again: heights may begin anew.
  void reset() { completion_.reset(); }

 private:
  bool checks_, completes_, takes_whole_drives_;
  bool learns_ = false;  // what moves in the newest scan
  OdometryJump jump_;
  std::size_t track_number_ = 0;
  PlanarCompletion completion_;
  Eigen::Isometry3d odom_from_world_ = Eigen::Isometry3d::Identity();
};

}  // namespace donex
