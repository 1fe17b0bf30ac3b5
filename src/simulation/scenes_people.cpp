// The hard cases about people on foot.
#include "core/pi.h"
#include "simulation/roadside.h"
#include "simulation/scenes.h"

namespace donex::simulation {

Scene makePedestrianSlow(std::uint64_t seed) {
  constexpr double kSpeed = 0.8;  // [m/s]
  SceneBuilder builder({}, seed);
  Random& random = builder.random();
  const SharedPath path = oval(140.0, 30.0, random.uniform(-3.1, 3.1));
  builder.ground().add({*path, 5.3});
  Roadside roadside;
  roadside.parked = 0.4;
  furnish(builder, *path, 0.0, path->length(), roadside);
  const double start = random.uniform(5.0, 60.0);
  builder.ego(onRightLane(path, start, swinging(4.0, 0.8, 9.0, random.uniform(0.0, 6.28))));
  addCrossings(builder, *path, 14, kSpeed, kSpeed);
  Traffic traffic;
  traffic.walkers = 30;
  traffic.slowest = traffic.fastest = kSpeed;
  populate(builder, path, traffic);
  return std::move(builder.scene());
}

Scene makeCrowd(std::uint64_t seed) {
  constexpr double kHalfWidth = 8.0;  // [m]
  GroundStyle style;
  style.kerb_height = 0.03;
  style.waves = 0.03;
  SceneBuilder builder(style, seed);
  Random& random = builder.random();
  const SharedPath path = oval(90.0, 20.0, random.uniform(-3.1, 3.1));
  builder.ground().add({*path, kHalfWidth});
  Roadside roadside;
  roadside.half_width = kHalfWidth;
  roadside.parked = 0.0;
  roadside.trees = 0.3;
  roadside.houses = 1.0;
  furnish(builder, *path, 0.0, path->length(), roadside);
  builder.ego(onRightLane(path, random.uniform(5.0, 30.0), SpeedProfile(1.4), 0.0));

  for (double s = 4.0; s < path->length(); s += random.uniform(5.0, 11.0)) {
    const double side = random.chance(0.5) ? 1.0 : -1.0;
    PathPoint place = path->at(s, side * random.uniform(5.5, 7.5));
    place.yaw = random.uniform(-3.1, 3.1);
    const bool somebody_waits = random.chance(0.7);
    if (somebody_waits) {
      builder.parked(place, makePerson(random));
    } else {
      builder.block(place, {2.0, 1.2, 1.0}, 99, 0.3f);
    }
  }
  Course course;
  course.path = path;
  for (int i = 0; i < 130; ++i) {
    const double side = random.chance(0.5) ? 1.0 : -1.0;
    course.backwards = random.chance(0.5);
    course.lateral = side * random.uniform(1.7, 9.5);
    course.speed = SpeedProfile(random.uniform(0.6, 1.6));
    builder.addClear(makePerson(random), course, 20.0);
  }
  course.speed = SpeedProfile(3.5);
  for (const double lateral : {-2.6, 2.6}) {
    course.backwards = lateral > 0.0;
    course.lateral = lateral;
    builder.addClear(makeCyclist(random), course, 20.0);
  }
  addCrossings(builder, *path, 12);
  return std::move(builder.scene());
}

Scene makeFarPeople(std::uint64_t seed) {
  constexpr double kNearest = 25.0, kFarthest = 48.0;  // [m] beside the way
  SceneBuilder builder({}, seed);
  Random& random = builder.random();
  const auto path = std::make_shared<const Path>(Path({0.0, 0.0}, random.uniform(-3.1, 3.1)).line(300.0).wrap());
  builder.ground().add({*path, 5.3});
  builder.ego(onRightLane(path, random.uniform(80.0, 120.0), SpeedProfile(3.0)));
  for (double s = 0.0; s < path->length(); s += random.uniform(9.0, 16.0)) {
    const double side = random.chance(0.5) ? 1.0 : -1.0;
    const Eigen::Vector2d place = path->at(s, side * random.uniform(kNearest, kFarthest)).position;
    random.chance(0.5) ? builder.tree(place) : builder.pole(place, 3.0, 0.1);
  }
  Course course;
  course.path = path;
  for (int i = 0; i < 90; ++i) {
    const double side = random.chance(0.5) ? 1.0 : -1.0;
    course.backwards = random.chance(0.5);
    course.lateral = side * random.uniform(kNearest, kFarthest);
    course.speed = SpeedProfile(random.uniform(0.8, 1.8));
    builder.addClear(makePerson(random), course, 30.0);
  }
  return std::move(builder.scene());
}

Scene makeCorners(std::uint64_t seed) {
  constexpr double kApart = 12.0, kHidden = 10.0, kCorner = 5.5, kRoad = 3.7;  // [m]
  constexpr double kRamp = 0.5;                                                // [s]
  SceneBuilder builder({}, seed);
  Random& random = builder.random();
  const auto path = std::make_shared<const Path>(Path({0.0, 0.0}, random.uniform(-3.1, 3.1)).line(360.0).wrap());
  builder.ground().add({*path, 5.3});
  const double start = random.uniform(20.0, 40.0);
  constexpr double kSpeed = 5.0;  // [m/s]
  builder.ego(onRightLane(path, start, SpeedProfile(kSpeed)));
  for (int i = 0; i < 24; ++i) {
    const double s = start + 14.0 + kApart * i;
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    builder.wall(path->at(s, side * kCorner).position, path->at(s, side * 16.0).position, 2.8);
    // Seen only once it has passed the corner, two or three seconds before the ego vehicle is there; stops at the road.
    const bool walks = random.chance(0.6);
    const double speed = walks ? random.uniform(1.2, 1.8) : random.uniform(2.5, 4.0);
    const double to_the_corner = (kHidden - kCorner) / speed;
    const double when = (s - start) / kSpeed - random.uniform(2.2, 3.2) - to_the_corner;
    const double walking = (kHidden - kRoad) / speed - kRamp;
    const PathPoint hidden = path->at(s + 1.5, side * kHidden);
    Course course;
    course.path = std::make_shared<const Path>(Path(hidden.position, hidden.yaw - side * 0.5 * kPi).line(60.0));
    course.speed = SpeedProfile(
        {{when, 0.0}, {when + kRamp, speed}, {when + kRamp + walking, speed}, {when + 2.0 * kRamp + walking, 0.0}});
    builder.add(walks ? makePerson(random) : makeCyclist(random), course);
  }
  return std::move(builder.scene());
}

}  // namespace donex::simulation
