// The beam tables of rotating sensors.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace donex::simulation {

struct SensorModel {
  std::vector<float> slopes;  ///< tangents of the beams' elevations, rising; one per ring
  /// Unit vectors in the sensor's axes, one per column; the first points backwards, then clockwise seen from above.
  std::vector<Eigen::Vector2d> headings;
  float min_range = 0.9f;  ///< [m]

  int beams() const { return static_cast<int>(slopes.size()); }
  int columns() const { return static_cast<int>(headings.size()); }  ///< firings a turn
};

/// 16 and 32: sparse sensors with even tables; 64: two blocks of beams, finer above; 128: densest around the horizon.
/// Throws std::invalid_argument for another number.
SensorModel makeSensorModel(int beams);

}  // namespace donex::simulation
