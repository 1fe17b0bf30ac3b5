// Two carriageways with three lanes each, guard rails, bridges, gantries.
#include <array>
#include <cmath>

#include "core/pi.h"
#include "simulation/roadside.h"
#include "simulation/scenes.h"

namespace donex::simulation {
namespace {

constexpr double kHalfWidth = 16.0;  // middle to the outer edge of the hard shoulder [m]
constexpr double kInnerLane = 3.7;   // middle of the road to the middle of the fast lane [m]
constexpr double kLaneWidth = 3.75;  // [m]

double laneAt(int lane) { return kInnerLane + kLaneWidth * lane; }

/// Lane 0 is the fast one. All vehicles of a lane keep their gaps.
SpeedProfile speedOf(int lane, double phase) {
  constexpr std::array kSpeeds{36.0, 29.0, 23.5};
  return swinging(kSpeeds.at(static_cast<std::size_t>(lane)), 0.6, 14.0, phase);
}

Model vehicleFor(Random& random, int lane) {
  if (lane == 2 && random.chance(0.55)) return makeLorry(random);
  return random.chance(0.8) ? makeCar(random) : makeVan(random);
}

void fillLane(SceneBuilder& builder, const SharedPath& path, int lane, bool opposite, double ego_start) {
  Random& random = builder.random();
  Course course;
  course.path = path;
  course.backwards = opposite;
  course.lateral = opposite ? laneAt(lane) : -laneAt(lane);
  const double phase = random.uniform(0.0, 6.28);
  const bool ego_lane = !opposite && lane == 1;
  const double room_behind = ego_lane ? 30.0 : 0.0;
  const double room_ahead = ego_lane ? 25.0 : 0.0;
  double s = ego_start + room_ahead + random.uniform(2.0, 25.0);
  const double end = ego_start + path->length() - room_behind - 30.0;
  for (; s < end; s += random.uniform(32.0, 80.0)) {
    course.start = s;
    course.speed = speedOf(lane, ego_lane ? -0.01 * (s - ego_start) : phase);
    builder.add(vehicleFor(random, lane), course);
  }
}

void addGantry(SceneBuilder& builder, const Path& path, double s) {
  for (const double lateral : {-17.2, -0.9}) builder.pole(path.at(s, lateral).position, 7.0, 0.18);
  for (int lane = 0; lane < 3; ++lane) builder.block(path.at(s, -laneAt(lane)), {0.3, 3.0, 1.8}, 81, 0.8f, 5.3);
}

void addBorders(SceneBuilder& builder, const Path& path) {
  Random& random = builder.random();
  const double length = path.length();
  for (const double lateral : {-0.55, 0.55}) builder.guardRail(path, 0.0, length, lateral);
  for (const double side : {-1.0, 1.0}) {
    builder.guardRail(path, 0.0, length, side * (kHalfWidth + 0.6));
    for (double s = 0.0; s < length; s += 50.0) {
      builder.pole(path.at(s, side * (kHalfWidth + 1.4)).position, 1.05, 0.06);
    }
    for (double s = 0.0; s < length; s += random.uniform(4.0, 16.0)) {
      const Eigen::Vector2d place = path.at(s, side * (kHalfWidth + random.uniform(4.0, 14.0))).position;
      if (random.chance(0.35)) {
        builder.tree(place);
      } else {
        const double height = random.uniform(1.0, 2.4);
        builder.bush(place, random.uniform(1.5, 3.0), height);
      }
    }
    for (double s = random.uniform(0.0, 300.0); s < length; s += random.uniform(300.0, 700.0)) {
      for (double x = 0.0; x < 120.0; x += 6.0) {
        const double lateral = side * (kHalfWidth + 3.0);
        builder.wall(path.at(s + x, lateral).position, path.at(s + x + 6.0, lateral).position, 3.5, 52);
      }
    }
  }
  for (double s = 120.0; s < length; s += random.uniform(350.0, 600.0)) {
    builder.bridge(path, s, 26.0, 5.4, 9.0);
    for (const double along : {-2.5, 2.5}) builder.pole(path.at(s + along).position, 5.4, 0.4, 52);
  }
  for (double s = 260.0; s < length; s += random.uniform(400.0, 700.0)) addGantry(builder, path, s);
}

}  // namespace

Scene makeMotorway(std::uint64_t seed) {
  GroundStyle style;
  style.pavement_width = 0.0;
  style.kerb_height = 0.0;
  style.verge_drop = 0.8;
  style.roughness = 0.08;
  SceneBuilder builder(style, seed);
  Random& random = builder.random();
  const double straight = random.uniform(900.0, 1300.0);
  const double radius = random.uniform(450.0, 600.0);
  const SharedPath path = oval(straight, radius, random.uniform(-kPi, kPi));
  builder.ground().add({*path, kHalfWidth});
  addBorders(builder, *path);

  const double start = random.uniform(20.0, 400.0);
  builder.ego(onRightLane(path, start, speedOf(1, 0.0), laneAt(1)));
  for (int lane = 0; lane < 3; ++lane) {
    fillLane(builder, path, lane, false, start);
    fillLane(builder, path, lane, true, start);
  }
  return std::move(builder.scene());
}

}  // namespace donex::simulation
