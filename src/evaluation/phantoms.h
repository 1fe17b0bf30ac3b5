// False moving objects: what a planner would brake for although nothing moves there.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace donex {

/// What counts as a phantom: a cluster of false echoes, far from anything that moves (there it is a blurred outline).
struct PhantomRules {
  double link = 0.8;             ///< echoes this near to each other belong together (single linkage) [m]
  std::size_t least_echoes = 5;  ///< in a phantom
  double clearance = 1.5;        ///< no truly moving echo is this near to an echo of a phantom [m]
};

/// Phantoms of one scan, from its echoes that are judged, static in truth and moving in the prediction, and those that
/// truly move; all of them finite.
std::size_t countPhantoms(const std::vector<Eigen::Vector3f>& false_echoes,
                          const std::vector<Eigen::Vector3f>& truly_moving, const PhantomRules& rules = {});

}  // namespace donex
