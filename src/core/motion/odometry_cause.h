// What is wrong with an odometry that disagrees with the scans: the one correction that mends it best.
#pragma once

#include <deque>
#include <string>

#include "core/motion/track_comparison.h"

namespace donex {

enum class OdometryCause {
  kUnknown,
  kMountingYaw,  ///< figure: [rad] by which the sensor is mounted farther to the left than is believed
  kScale,        ///< figure: the odometry's lengths over the true ones
  kTimeOffset,   ///< figure: [s] by which the odometry's stamps are late
  kAxes,         ///< no figure; the detail tells which
  kWorldTwist,   ///< velocities are told in the fixed frame's axes; no figure
  kFrozen,       ///< figure: scans without motion
  kJump,         ///< figure: [m]
};

struct CauseFinding {
  OdometryCause cause = OdometryCause::kUnknown;
  double figure = 0.0;
  std::string detail;
  double before = 0.0;     ///< mean harm of the windows
  double remaining = 0.0;  ///< with the correction
};

/// "its scale, 1.050 times the true lengths".
std::string describe(const CauseFinding& finding);

/// Tries the corrections on the scans given. `is_twist`: the odometry's poses are integrated velocities.
CauseFinding findCause(const std::deque<ComparedScan>& scans, const ComparisonWindow& window, bool is_twist);

}  // namespace donex
