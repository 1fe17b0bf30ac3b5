// Where somebody will be: who would drive into whom.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "simulation/scene.h"

namespace donex::simulation {

/// A course with a footprint, in steps over the first minute and a bit.
struct Track {
  std::vector<PathPoint> places;
  Eigen::Vector2d half = Eigen::Vector2d::Zero();  ///< of the footprint, along and across [m]
};

Track trackOf(const Course& course, const Eigen::Vector2d& half);

/// Do the two never touch within `horizon` [s]?
bool stayClear(const Track& a, const Track& b, double horizon);

}  // namespace donex::simulation
