// Motion distortion undone: every echo as if the whole scan had been measured at its stamp.
#pragma once

#include <vector>

#include "donex/motion/ego_motion.h"

namespace donex {

/// Moves each echo from the sensor frame at `stamp` + `times[i]` into the sensor frame at `stamp`.
/// `echoes` in the sensor frame [m]; `times` relative to `stamp` [s], one per echo. Non-finite echoes stay as
/// they are and their times do not matter. On any fault `echoes` is untouched.
MotionFault deskew(const EgoMotion& motion, double stamp, const Eigen::Isometry3d& base_from_sensor,
                   const std::vector<float>& times, std::vector<Eigen::Vector3f>& echoes);

}  // namespace donex
