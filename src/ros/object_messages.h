// The objects that a detector follows, for planners and trackers.
#pragma once

#include <string>

#include <donex/MovingObjects.h>

#include "donex/detector.h"

namespace donex {

/// The objects of the detector's last scan, taken at `stamp`, in the odometry frame. Also made, empty,
/// where nothing moves.
MovingObjectsPtr toMessage(const Detector& detector, const ros::Time& stamp, const std::string& odom_frame,
                           const Eigen::Isometry3d& odom_from_world);

}  // namespace donex
