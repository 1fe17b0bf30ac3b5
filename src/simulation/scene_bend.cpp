// A roundabout with four arms; two of them are the ends of one winding road.
#include <cmath>

#include "core/pi.h"
#include "simulation/roadside.h"
#include "simulation/scenes.h"

namespace donex::simulation {
namespace {

constexpr double kLane = 1.55;      // beside a road's middle [m]
constexpr double kHalfWidth = 5.3;  // of the arms [m]
constexpr double kFarArm = 200.0;   // [m]

/// Counter-clockwise around the origin.
struct Ring {
  double radius;
  double flare;  ///< radius of the way in and of the way out

  /// From the middle to where the straight arm ends.
  double lead() const { return std::sqrt(std::pow(radius + flare, 2) - std::pow(kLane + flare, 2)); }
  /// Turned to the right on the way in, and again on the way out.
  double flareAngle() const { return std::atan2(lead(), kLane + flare); }
  /// Quarters: 0 leaves to the right, 1 straight on, 2 to the left, 4 to the right after a whole round.
  double turnFor(int quarters) const { return 2.0 * flareAngle() + 0.5 * kPi * (quarters - 1); }

  /// On the right lane of an arm, heading for the middle, `before` from the end of its straight part.
  Path approach(double yaw, double before) const {
    const PathPoint heading{Eigen::Vector2d::Zero(), yaw, 0.0};
    Path path(-(lead() + before) * heading.forward() - kLane * heading.left(), yaw);
    path.line(before);
    return path;
  }
  void pass(Path& path, int quarters) const {
    path.arc(flare, -flareAngle()).arc(radius, turnFor(quarters)).arc(flare, -flareAngle());
  }
};

/// The winding road between the east arm and the south arm: four straights, three bends to the right.
struct Loop {
  Ring ring;
  double bend;  ///< radius of the right lane [m]
  double east;  ///< straights, seen from the ring [m]
  double south;

  double west() const { return ring.lead() + east - bend - kLane; }
  double north() const { return south + bend + kLane - ring.lead(); }

  SharedPath egoCircuit() const {
    Path path = ring.approach(0.5 * kPi, north());
    ring.pass(path, 4);
    path.line(east).arc(bend, -0.5 * kPi).line(south).arc(bend, -0.5 * kPi).line(west()).arc(bend, -0.5 * kPi);
    return std::make_shared<const Path>(path.wrap());
  }
  SharedPath oppositeCircuit() const {
    const double outer = bend + 2.0 * kLane;
    Path path = ring.approach(kPi, east);
    ring.pass(path, 2);
    path.line(north()).arc(outer, 0.5 * kPi).line(west()).arc(outer, 0.5 * kPi).line(south).arc(outer, 0.5 * kPi);
    return std::make_shared<const Path>(path.wrap());
  }
  Path middle() const {
    const double radius = bend + kLane;
    Path path(Eigen::Vector2d(ring.radius, 0.0), 0.0);
    path.line(ring.lead() - ring.radius + east).arc(radius, -0.5 * kPi).line(south).arc(radius, -0.5 * kPi);
    path.line(west()).arc(radius, -0.5 * kPi).line(north() + ring.lead() - ring.radius);
    return path;
  }
};

void addIsland(SceneBuilder& builder, double radius) {
  Random& random = builder.random();
  for (int i = 0; i < 9; ++i) {
    const double angle = random.uniform(0.0, 2.0 * kPi);
    const Eigen::Vector2d place = random.uniform(0.2, 1.0) * radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    const double width = random.uniform(0.8, 1.8);
    if (i < 2) builder.tree(place);
    builder.bush(place, width, 0.8 * width);
  }
}

/// Traffic between the two far arms.
void addFarTraffic(SceneBuilder& builder, const Ring& ring) {
  const auto add = [&](double yaw, int quarters) {
    Path path = ring.approach(yaw, kFarArm);
    ring.pass(path, quarters);
    Course course;
    course.path = std::make_shared<const Path>(path.line(kFarArm).wrap());
    course.speed = swinging(builder.random().uniform(6.5, 8.0), 0.6, 9.0, 0.0);
    for (int i = 0; i < 3; ++i) builder.addClear(makeAnyVehicle(builder.random()), course, 60.0);
  };
  add(0.0, 2);
  add(-0.5 * kPi, 0);
}

/// People walking on both pavements, and across the road.
void addPeople(SceneBuilder& builder, const SharedPath& road) {
  addCrossings(builder, *road, 8);
  Traffic traffic;
  traffic.walkers = 24;
  populate(builder, road, traffic);
}

}  // namespace

Scene makeBend(std::uint64_t seed) {
  SceneBuilder builder({}, seed);
  Random& random = builder.random();
  Loop loop{{random.uniform(14.0, 17.0), 8.0}, random.uniform(11.0, 15.0), 0.0, 0.0};
  loop.east = random.uniform(55.0, 80.0);
  loop.south = random.uniform(65.0, 90.0);
  const Ring& ring = loop.ring;
  const auto middle = std::make_shared<const Path>(loop.middle());
  builder.ground().add({Path({ring.radius, 0.0}, 0.5 * kPi).arc(ring.radius, 2.0 * kPi), 4.2});
  builder.ground().add({*middle, kHalfWidth});
  for (const double yaw : {0.5 * kPi, kPi}) {
    builder.ground().add(
        {Path(ring.radius * Eigen::Vector2d(std::cos(yaw), std::sin(yaw)), yaw).line(kFarArm), kHalfWidth});
  }
  Roadside roadside;
  roadside.parked = 0.35;
  furnish(builder, *middle, 8.0, middle->length() - 8.0, roadside);
  for (const double yaw : {0.5 * kPi, kPi}) {
    const Path arm = Path(Eigen::Vector2d::Zero(), yaw).line(120.0);
    furnish(builder, arm, ring.radius + 8.0, 110.0, roadside);
  }
  addIsland(builder, ring.radius - 7.0);

  Course course;
  course.path = loop.egoCircuit();
  course.speed = swinging(7.2, 0.9, 10.0, random.uniform(0.0, 6.28));
  course.start = random.uniform(0.3, 0.7) * loop.north();
  builder.ego(course);
  for (int i = 0; i < 4; ++i) builder.addClear(makeAnyVehicle(random), course, 60.0);
  course.path = loop.oppositeCircuit();
  for (int i = 0; i < 5; ++i) builder.addClear(makeAnyVehicle(random), course, 60.0);
  addFarTraffic(builder, ring);
  addPeople(builder, middle);
  return std::move(builder.scene());
}

}  // namespace donex::simulation
