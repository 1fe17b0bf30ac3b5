// A street, a crossroads.
#include <cmath>

#include "core/pi.h"
#include "simulation/roadside.h"
#include "simulation/scenes.h"

namespace donex::simulation {
namespace {

/// Round a block of houses, to the left.
SharedPath blockCircuit(Random& random) {
  const double length = random.uniform(180.0, 260.0);
  const double width = random.uniform(90.0, 120.0);
  Path path({0.0, 0.0}, random.uniform(-kPi, kPi));
  for (int i = 0; i < 2; ++i) path.line(length).arc(16.0, 0.5 * kPi).line(width).arc(16.0, 0.5 * kPi);
  return std::make_shared<const Path>(path.wrap());
}

constexpr double kArm = 170.0;  // of a crossroads: the traffic returns out of sight [m]
/// Everyone's round takes as long, or a whole fraction: who met nobody once never does.
constexpr double kRound = 36.0;  // [s]

void addCrossroadsTraffic(SceneBuilder& builder) {
  Random& random = builder.random();
  const double speed = 2.0 * kArm / kRound;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const double yaw = 0.5 * kPi * quarter;
    const Eigen::Vector2d start = -kArm * Eigen::Vector2d(std::cos(yaw), std::sin(yaw));
    const auto straight = std::make_shared<const Path>(Path(start, yaw).line(2.0 * kArm).wrap());
    const bool ego_arm = quarter == 1;
    const int vehicles = ego_arm ? 0 : 3;
    for (int i = 0; i < vehicles; ++i) {
      builder.addClear(makeAnyVehicle(random), onRightLane(straight, 0.0, SpeedProfile(speed)), kRound);
    }
    Course cyclist = onRightLane(straight, 0.0, SpeedProfile(0.5 * speed), 2.95);
    for (int i = 0; i < 2 && !ego_arm; ++i) builder.addClear(makeCyclist(random), cyclist, 2.0 * kRound);
  }
}

/// From the south lane's opposite into the west arm, and a bus' turn from the east to the north.
void addTurningTraffic(SceneBuilder& builder) {
  Random& random = builder.random();
  const auto turn = [&](double yaw, double radius, double angle) {
    const double straight = kArm - radius;
    const Eigen::Vector2d start = -kArm * Eigen::Vector2d(std::cos(yaw), std::sin(yaw));
    Path path(start, yaw);
    const double rest = 2.0 * kArm - straight - radius * std::abs(angle);
    path.line(straight).arc(radius, angle).line(rest).wrap();
    return std::make_shared<const Path>(path);
  };
  const SpeedProfile speed(2.0 * kArm / kRound);
  builder.addClear(makeCar(random), onRightLane(turn(-0.5 * kPi, 10.0, -0.5 * kPi), 0.0, speed), kRound);
  builder.addClear(makeBus(random), onRightLane(turn(kPi, 12.0, -0.5 * kPi), 0.0, speed), kRound);
}

void addCrossroadsPeople(SceneBuilder& builder) {
  Random& random = builder.random();
  for (int i = 0; i < 7; ++i) {
    Course course;
    const double yaw = 0.5 * kPi * random.below(4);
    const Eigen::Vector2d arm(std::cos(yaw), std::sin(yaw));
    course.path = crossing({random.uniform(8.0, 10.0) * arm, yaw, 0.0}, 7.0);
    course.speed = SpeedProfile(course.path->length() / kRound * 1.5);
    builder.addClear(makePerson(random), course, 2.0 * kRound);
  }
  for (int i = 0; i < 16; ++i) {
    const double yaw = 0.5 * kPi * random.below(4);
    const Eigen::Vector2d arm(std::cos(yaw), std::sin(yaw));
    Course course;
    course.path =
        std::make_shared<const Path>(Path(14.0 * arm, yaw).line(45.0).arc(0.8, kPi).line(45.0).arc(0.8, kPi).wrap());
    const double side = random.chance(0.5) ? 5.9 : -6.9;
    course.lateral = side + random.uniform(-0.3, 0.3);
    course.speed = SpeedProfile(random.uniform(0.8, 1.7));
    builder.addClear(makePerson(random), course, kRound);
  }
}

}  // namespace

Scene makeStreet(std::uint64_t seed) {
  SceneBuilder builder({}, seed);
  Random& random = builder.random();
  const SharedPath path = blockCircuit(random);
  builder.ground().add({*path, 5.3});
  furnish(builder, *path, 0.0, path->length(), {});

  const double phase = random.uniform(0.0, 6.28);
  const double speed = random.uniform(7.0, 9.5);
  const SpeedProfile profile = swinging(speed, 1.5, 12.0, phase);
  const double start = random.uniform(10.0, 60.0);
  builder.ego(onRightLane(path, start, profile));
  for (const double ahead : {random.uniform(22.0, 32.0), random.uniform(48.0, 70.0), -random.uniform(14.0, 25.0)}) {
    builder.add(makeAnyVehicle(random),
                onRightLane(path, start + ahead, swinging(speed, 1.5, 12.0, phase - 0.02 * ahead)));
  }
  Traffic traffic;
  traffic.oncoming = 14;
  traffic.walkers = 70;
  traffic.cyclists = 14;
  populate(builder, path, traffic);
  addCrossings(builder, *path, 10);
  return std::move(builder.scene());
}

Scene makeIntersection(std::uint64_t seed) {
  SceneBuilder builder({}, seed);
  for (const double yaw : {0.0, 0.5 * kPi}) {
    const Eigen::Vector2d start = -kArm * Eigen::Vector2d(std::cos(yaw), std::sin(yaw));
    builder.ground().add({Path(start, yaw).line(2.0 * kArm), 5.3});
  }
  for (const double yaw : {0.0, 0.5 * kPi, kPi, 1.5 * kPi}) {
    const Path arm = Path(Eigen::Vector2d::Zero(), yaw).line(110.0);
    Roadside half;
    furnish(builder, arm, 13.0, 100.0, half);
  }
  const auto ego_lane = std::make_shared<const Path>(Path({0.0, -15.0}, 0.5 * kPi).line(1.0));
  builder.ego(onRightLane(ego_lane, 0.0, SpeedProfile(0.0)));
  addCrossroadsTraffic(builder);
  addTurningTraffic(builder);
  addCrossroadsPeople(builder);
  return std::move(builder.scene());
}

}  // namespace donex::simulation
