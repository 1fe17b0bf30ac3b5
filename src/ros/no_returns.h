// Beams without an echo for which a position was written all the same.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace donex {

struct NoReturns {
  std::size_t at_sensor = 0;
  std::size_t at_largest_range = 0;
  float largest_range = 0.0F;  ///< where they lie [m]; 0 where none do
};

/// Makes them NaN, the mark of a beam without an echo: drivers write the sensor's own place, which is no longer zero in
/// a cloud that was moved, and simulators the end of the beam. To be asked before de-skewing, which moves each echo
/// differently. `sensor` [m] is in the echoes' frame.
NoReturns removeNoReturns(const Eigen::Vector3f& sensor, std::vector<Eigen::Vector3f>& echoes);

}  // namespace donex
