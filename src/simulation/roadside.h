// What stands beside roads.
#pragma once

#include "simulation/scene_builder.h"

namespace donex::simulation {

/// How a side of a road is furnished; a chance of 0 leaves an item out.
struct Roadside {
  double half_width = 5.3;         ///< of the road [m]
  double pavement = 2.5;           ///< [m]
  double parked = 0.6;             ///< chance of a vehicle in a parking place of 6.3 m
  double trees = 0.6;              ///< chance every 11 m
  double houses = 0.85;            ///< chance a plot
  double gardens = 0.5;            ///< chance of a fence, hedge or wall before a house
  double bushes = 0.2;             ///< chance every 5 m, behind the pavement
  float sway = 0.0f;               ///< of everything with leaves [m]
  std::vector<double> no_parking;  ///< places along the path where nobody parks [m]
};

/// Both sides of the path between two places, with nothing on any road. Add the roads to the ground first.
void furnish(SceneBuilder& builder, const Path& path, double from, double to, const Roadside& roadside);

struct Traffic {
  double lane = 1.45;           ///< middle of the lane beside the road's [m]
  int oncoming = 0;             ///< vehicles, over the whole path
  double oncoming_speed = 9.0;  ///< [m/s]
  int walkers = 0;              ///< on the pavements
  double pavement = 6.5;        ///< their middle beside the road's [m]
  double slowest = 0.9;         ///< walker [m/s]
  double fastest = 1.7;
  int cyclists = 0;
};

/// Vehicles against the path's direction, people on both pavements, cyclists both ways: meeting nobody for `horizon`
/// [s].
void populate(SceneBuilder& builder, const SharedPath& path, const Traffic& traffic, double horizon = 30.0);

/// People who cross the road here and there.
void addCrossings(SceneBuilder& builder, const Path& path, int count, double slowest = 1.0, double fastest = 1.5);

/// A car mostly, now and then a van, seldom a lorry.
Model makeAnyVehicle(Random& random);

/// On the path, in the lane to the right of its middle.
Course onRightLane(const SharedPath& path, double start, const SpeedProfile& speed, double lane = 1.45);

}  // namespace donex::simulation
