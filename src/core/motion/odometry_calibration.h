// What two tracks tell of mounting, scale and stamps, and how surely.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "core/motion/track_comparison.h"

namespace donex {

/// One quantity; where the drive does not tell it, only that.
struct CalibrationFigure {
  bool is_known = false;
  double value = 0.0, deviation = 0.0;  ///< deviation: standard deviation of the value
};

struct OdometryCalibration {
  CalibrationFigure yaw;          ///< by which the sensor is mounted farther to the left than is believed [rad]
  CalibrationFigure scale;        ///< the odometry's lengths over the true ones
  CalibrationFigure time_offset;  ///< by which the odometry's stamps are late [s]
};

/// Yaw and scale need way, the stamps need turns or changes of speed.
OdometryCalibration calibrate(const std::deque<ComparedScan>& scans, const ComparisonWindow& window);

/// A line for each, with what mends it; `base_from_sensor` is the mounting as it is believed.
std::vector<std::string> describe(const OdometryCalibration& calibration, const Eigen::Isometry3d& base_from_sensor,
                                  const std::string& base_frame, const std::string& sensor_frame);

}  // namespace donex
