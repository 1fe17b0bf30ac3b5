// The hard cases whose difficulty is what stands around, and where the ego vehicle goes.
#include <cmath>

#include "core/pi.h"
#include "simulation/roadside.h"
#include "simulation/scenes.h"

namespace donex::simulation {
namespace {

constexpr double kHalfWidth = 5.3;  // [m]

SharedPath addRoad(SceneBuilder& builder, double straight, double radius, const Roadside& roadside) {
  SharedPath path = oval(straight, radius, builder.random().uniform(-kPi, kPi));
  builder.ground().add({*path, roadside.half_width});
  furnish(builder, *path, 0.0, path->length(), roadside);
  return path;
}

void egoOn(SceneBuilder& builder, const SharedPath& path, double speed) {
  Random& random = builder.random();
  const double start = random.uniform(5.0, 80.0);
  builder.ego(onRightLane(path, start, swinging(speed, 0.12 * speed, 11.0, random.uniform(0.0, 6.28))));
}

}  // namespace

Scene makeFoliage(std::uint64_t seed) {
  SceneBuilder builder({}, seed);
  Roadside roadside;
  roadside.parked = 0.1;
  roadside.trees = 0.9;
  roadside.houses = 0.25;
  roadside.bushes = 0.8;
  roadside.sway = 0.03f;
  const SharedPath path = addRoad(builder, 160.0, 35.0, roadside);
  for (const double side : {-1.0, 1.0}) {
    builder.hedge(*path, 10.0, 70.0, side * (kHalfWidth + 2.9), 1.5, roadside.sway);
    builder.hedge(*path, 90.0, 150.0, side * (kHalfWidth + 0.7), 0.9, roadside.sway);
  }
  egoOn(builder, path, 6.0);
  Traffic traffic;
  traffic.oncoming = 6;
  traffic.walkers = 25;
  traffic.cyclists = 6;
  populate(builder, path, traffic);
  return std::move(builder.scene());
}

Scene makeFences(std::uint64_t seed) {
  SceneBuilder builder({}, seed);
  Roadside roadside;
  roadside.parked = 0.0;
  roadside.trees = 0.2;
  const SharedPath path = addRoad(builder, 220.0, 40.0, roadside);
  builder.picketFence(*path, 0.0, 215.0, -(kHalfWidth + 0.7), 1.1);
  builder.picketFence(*path, 0.0, 100.0, kHalfWidth + 2.2, 1.2);
  builder.guardRail(*path, 110.0, 216.0, kHalfWidth + 0.4);
  egoOn(builder, path, 9.0);
  Traffic traffic;
  traffic.oncoming = 7;
  traffic.walkers = 30;
  traffic.pavement = 7.0;
  traffic.cyclists = 4;
  populate(builder, path, traffic);
  return std::move(builder.scene());
}

Scene makeBridges(std::uint64_t seed) {
  SceneBuilder builder({}, seed);
  Random& random = builder.random();
  Roadside roadside;
  roadside.parked = 0.1;
  roadside.trees = 0.8;
  roadside.houses = 0.4;
  const SharedPath path = addRoad(builder, 300.0, 60.0, roadside);
  for (double s = 35.0; s < 290.0; s += random.uniform(45.0, 75.0)) {
    const double clearance = random.uniform(4.4, 5.4);
    builder.bridge(*path, s, 18.0, clearance, random.uniform(5.0, 12.0));
    builder.block(path->at(s + 22.0, -2.0), {0.2, 3.0, 1.2}, 81, 0.8f, 4.6);
    for (const double lateral : {-6.2, 6.2}) builder.pole(path->at(s + 22.0, lateral).position, 5.8, 0.12);
    builder.block(path->at(s + 22.0), {0.15, 12.4, 0.2}, 80, 0.4f, 5.7);
  }
  egoOn(builder, path, 11.0);
  Traffic traffic;
  traffic.oncoming = 12;
  traffic.oncoming_speed = 12.0;
  traffic.walkers = 20;
  traffic.cyclists = 4;
  populate(builder, path, traffic);
  return std::move(builder.scene());
}

Scene makeSlope(std::uint64_t seed) {
  SceneBuilder builder({}, seed);
  Random& random = builder.random();
  const double yaw = random.uniform(-kPi, kPi);
  const double grade = random.uniform(0.07, 0.11);
  const Eigen::Vector2d along(std::cos(yaw), std::sin(yaw));
  builder.ground().add(Slope{35.0 * along, yaw, 110.0, grade});
  builder.ground().add(Slope{190.0 * along, yaw, 80.0, -grade});
  const SharedPath path = oval(320.0, 40.0, yaw);
  builder.ground().add({*path, kHalfWidth});
  furnish(builder, *path, 0.0, path->length(), {});
  egoOn(builder, path, 9.5);
  Traffic traffic;
  traffic.oncoming = 14;
  traffic.walkers = 30;
  traffic.cyclists = 6;
  populate(builder, path, traffic);
  return std::move(builder.scene());
}

Scene makeTurning(std::uint64_t seed) {
  SceneBuilder builder({}, seed);
  Random& random = builder.random();
  const double speed = 5.0;
  const double radius = speed / (30.0 * kPi / 180.0);
  Path ring({0.0, 0.0}, random.uniform(-kPi, kPi));
  for (const double length : {12.0, 16.0, 12.0, 16.0}) ring.line(length).arc(radius, 0.5 * kPi);
  const auto path = std::make_shared<const Path>(ring.wrap());
  builder.ground().add({*path, kHalfWidth});
  furnish(builder, *path, 0.0, path->length(), {});
  builder.ego(onRightLane(path, random.uniform(0.0, 20.0), SpeedProfile(speed)));
  Traffic traffic;
  traffic.oncoming = 2;
  traffic.oncoming_speed = 5.0;
  traffic.walkers = 12;
  populate(builder, path, traffic);
  addCrossings(builder, *path, 2);
  return std::move(builder.scene());
}

Scene makeEmptyRoom(std::uint64_t seed) {
  GroundStyle style;
  style.pavement_width = style.kerb_height = style.waves = style.roughness = 0.0;
  style.land_label = 49;
  SceneBuilder builder(style, seed);
  Random& random = builder.random();
  const double length = random.uniform(6.0, 9.0);
  const double width = random.uniform(4.5, 7.0);
  const PathPoint middle{Eigen::Vector2d::Zero(), 0.0, 0.0};
  builder.block(middle, {length + 1.0, width + 1.0, 0.2}, 50, 0.6f, 2.8);
  for (const double side : {-0.5, 0.5}) {
    builder.block({{side * (length + 0.2), 0.0}, 0.0, 0.0}, {0.2, width, 2.9}, 50, 0.5f);
    builder.block({{0.0, side * (width + 0.2)}, 0.0, 0.0}, {length, 0.2, 2.9}, 50, 0.5f);
  }
  const auto at = [&](double x, double y) {
    return PathPoint{{x * length, y * width}, random.uniform(-0.2, 0.2), 0.0};
  };
  const PathPoint table = at(0.22, 0.2);
  builder.block(table, {1.6, 0.8, 0.04}, 52, 0.4f, 0.72);
  for (const double x : {-0.7, 0.7}) {
    for (const double y : {-0.32, 0.32}) {
      builder.pole(table.position + x * table.forward() + y * table.left(), 0.72, 0.03, 52);
    }
  }
  builder.block(at(0.22, 0.02), {0.45, 0.45, 0.9}, 52, 0.3f);
  builder.block({{-0.5 * length + 0.3, 0.2 * width}, 0.0, 0.0}, {0.5, 1.8, 2.0}, 52, 0.35f);
  builder.block({{0.1 * length, -0.5 * width + 0.15}, 0.0, 0.0}, {1.4, 0.12, 0.6}, 52, 0.5f, 0.15);
  builder.bush(at(-0.35, -0.33).position, 0.6, 1.1);

  Course course;
  const double yaw = random.uniform(-kPi, kPi);
  course.path = std::make_shared<const Path>(Path(at(-0.05, -0.08).position, yaw).line(1.0));
  builder.ego(course);
  builder.scene().ego.base_from_sensor = Eigen::Translation3d(0.0, 0.0, 1.2);
  builder.scene().beams = 16;
  return std::move(builder.scene());
}

}  // namespace donex::simulation
