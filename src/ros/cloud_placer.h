// Clouds that are told in another frame than that of their sensor: lines of sight begin where the sensor was.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <tf2/buffer_core.h>

#include "donex/config.h"
#include "ros/motion_source.h"

namespace donex {

class CloudPlacer {
 public:
  /// `tf` must outlive it.
  CloudPlacer(const Config& config, const tf2::BufferCore& tf);

  /// The frame whose motion is asked for, for clouds of this one.
  std::string movingFrame(const std::string& cloud_frame, OdometrySource source) const;

  /// Tells the motion where the sensor is in the cloud; or why a cloud of this frame cannot be judged: never is the
  /// frame's origin taken for the sensor where the frame stands still and the vehicle moves.
  std::optional<MotionMissing> place(const ros::Time& stamp, const std::string& cloud_frame, OdometrySource source,
                                     ScanMotion& motion);

  void reset() { first_places_.clear(); }

 private:
  std::optional<MotionMissing> refuseMoving(const std::string& frame, const ScanMotion& motion);

  CloudConfig config_;
  std::string fixed_frame_;
  const tf2::BufferCore& tf_;
  std::map<std::string, Eigen::Vector3d> first_places_;  // of each frame of clouds in the vehicle's [m]
};

void moveEchoes(const Eigen::Isometry3d& motion, std::vector<Eigen::Vector3f>& echoes);

}  // namespace donex
