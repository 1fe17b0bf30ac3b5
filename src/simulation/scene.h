// A place with everything in it, and who moves how.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "simulation/ground.h"
#include "simulation/model.h"
#include "simulation/path.h"
#include "simulation/speed_profile.h"

namespace donex::simulation {

/// A solid that stays where it is.
struct Fixture {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< scene frame [m]; shape.center is not used
  Shape shape;
  std::uint32_t label = 99;
  float reflectivity = 0.3f;
  float sway = 0.0f;  ///< amplitude of its swing in the wind [m]
};

/// Along a path by a speed.
struct Course {
  std::shared_ptr<const Path> path;
  double start = 0.0;         ///< where on the path at the profile's first knot [m]
  double lateral = 0.0;       ///< to the left of the path [m]
  bool backwards = false;     ///< against the path's direction
  double shift = 0.0;         ///< further to the left in the end: pulls out, or changes the lane [m]
  double shift_begin = 0.0;   ///< after this way [m]
  double shift_length = 0.0;  ///< over this way; 0: no shift [m]
  SpeedProfile speed{0.0};

  double way(double time) const { return speed.distance(time); }
  PathPoint at(double time) const;
  /// Speed over the ground: further than along the path on the outside of a bend [m/s].
  double groundSpeed(double time) const;
};

struct Mover {
  Model model;
  Course course;
};

struct Ego {
  Course course;
  bool suspension = true;  ///< roll, pitch and heave while it drives
  Eigen::Isometry3d base_from_sensor = Eigen::Isometry3d::Identity();
};

struct Scene {
  Ground ground;
  std::vector<Fixture> fixtures;
  std::vector<Mover> movers;
  Ego ego;
  int beams = 64;  ///< of a sensor that suits it
};

/// Same name and seed, same scene. Throws std::invalid_argument for an unknown name.
Scene makeScene(const std::string& name, std::uint64_t seed);

/// Pose of the mover on the ground: it leans with the slope along its way.
Eigen::Isometry3d poseOf(const Mover& mover, const Ground& ground, double time);
/// The class it has at that moment, by the rule of SimulatedScan::labels.
std::uint32_t labelOf(const Mover& mover, double time);
/// Pose of the ego vehicle: on its wheels, on its springs. Smooth over time where the course is.
Eigen::Isometry3d poseOf(const Ego& ego, const Ground& ground, double time);

}  // namespace donex::simulation
