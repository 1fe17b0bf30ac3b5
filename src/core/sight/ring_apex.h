// Where a spinning sensor is in clouds that were moved into another frame, found from their rings.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace donex {

struct RingApexOptions {
  std::size_t echoes = 6000;        ///< about so many are used, spread evenly over the cloud
  std::size_t least_of_ring = 20;   ///< with fewer a ring tells nothing
  std::size_t least_rings = 4;      ///< of so many echoes
  int rounds = 12;                  ///< of the adjustment
  double largest_step = 2.0;        ///< of one round [m]
  double nearest = 0.5;             ///< echoes nearer to the apex tell no direction [m]
  double least_scale = 1e-4;        ///< of errors that count in full [rad]
  double largest_error = 0.002;     ///< typical, of the elevations within a ring [rad]: else no cones, or many sensors
  double largest_deviation = 0.05;  ///< of the apex, along its worst axis [m]: flat ground alone tells no height
};

/// A beam of a spinning sensor turns on a cone, so the echoes of a ring lie on one, and the cones of all rings share
/// their apex: the sensor. Adjusts apex and common axis to all rings at once, by robust least squares of sines of
/// elevations.
///
/// `rings` has the number of each echo's ring, one entry per echo, `echoes` their positions in any frame [m]; echoes
/// that are not finite are left out. Returns the apex in that frame [m]; nothing where the rings do not determine it
/// within the options' bounds.
std::optional<Eigen::Vector3d> findRingApex(const std::vector<Eigen::Vector3f>& echoes,
                                            const std::vector<std::uint32_t>& rings,
                                            const RingApexOptions& options = {});

}  // namespace donex
