// What the simulated sensor measures of one ray.
#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace donex::simulation {

struct SimulatedEcho {
  Eigen::Vector3f position;  ///< sensor frame at the echo's own time [m]
  float intensity = 0.0f;    ///< 0 to 1
  float time = 0.0f;         ///< after the scan's stamp [s]: negative with distortion, 0 without
  std::uint16_t ring = 0;    ///< 0 is the lowest beam; a laser of a non-repetitive pattern
};

}  // namespace donex::simulation
