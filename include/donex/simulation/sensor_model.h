// The beam tables of rotating sensors.
#pragma once

#include <vector>

namespace donex::simulation {

struct SensorModel {
  std::vector<float> slopes;  ///< tangents of the beams' elevations, rising; one a ring
  int columns = 0;            ///< firings a turn
  float min_range = 0.9f;     ///< [m]

  int beams() const { return static_cast<int>(slopes.size()); }
  /// Azimuth of a firing [rad]: begins at the rear and turns clockwise seen from above.
  double azimuth(int column) const;
};

/// 16 and 32: sparse sensors with even tables; 64: two blocks of beams, finer above; 128: densest around the horizon.
/// Throws std::invalid_argument for another number.
SensorModel makeSensorModel(int beams);

}  // namespace donex::simulation
