// The hard cases whose difficulty is how a vehicle moves.
#include "core/pi.h"
#include "simulation/roadside.h"
#include "simulation/scenes.h"

namespace donex::simulation {
namespace {

constexpr double kLane = 1.45;     // [m]
constexpr double kParking = 4.15;  // middle of the road to a parked car's middle [m]

/// A circuit between houses.
SharedPath addTownRoad(SceneBuilder& builder, double straight, const Roadside& roadside = {}) {
  SharedPath path = oval(straight, 40.0, builder.random().uniform(-3.1, 3.1));
  builder.ground().add({*path, roadside.half_width});
  furnish(builder, *path, 0.0, path->length(), roadside);
  return path;
}

void addUsualTraffic(SceneBuilder& builder, const SharedPath& path) {
  Traffic traffic;
  traffic.oncoming = 8;
  traffic.walkers = 30;
  traffic.cyclists = 5;
  populate(builder, path, traffic);
}

Course pullingOut(const SharedPath& path, double place, double when, bool other_side) {
  Course course;
  course.path = path;
  course.start = place;
  course.backwards = other_side;
  course.lateral = other_side ? kParking : -kParking;
  course.shift = other_side ? kLane - kParking : kParking - kLane;
  course.shift_begin = 0.8;
  course.shift_length = 13.0;
  course.speed = SpeedProfile({{when, 0.0}, {when + 4.0, 7.0}});
  return course;
}

/// The left door of a car that is parked to the right of the path, or the other way round: a metre long, hinged in
/// front. It opens by 63 degrees.
void addDoor(SceneBuilder& builder, const Path& path, double place, bool other_side, double when) {
  constexpr double kHalfCar = 0.92, kHalfDoor = 0.5;  // [m]
  const double parking = other_side ? kParking : -kParking;
  const PathPoint closed = path.at(place, parking + (other_side ? -kHalfCar : kHalfCar));
  builder.parked(path.at(place, parking), makeCar(builder.random()));
  Model door;
  Shape shape;
  shape.center = {0.0F, 0.0F, 0.8F};
  shape.half = {0.03F, 0.5F, 0.5F};
  door.parts.push_back({shape, 0.4F});
  const double outwards = closed.yaw + (other_side ? -0.5 : 0.5) * kPi;
  Course course;
  course.path = std::make_shared<const Path>(Path(closed.position, outwards).arc(kHalfDoor, other_side ? 1.1 : -1.1));
  course.speed = SpeedProfile({{when, 0.0}, {when + 0.3, 0.5}, {when + 1.1, 0.5}, {when + 1.4, 0.0}});
  builder.add(door, course);
}

}  // namespace

Scene makeQueue(std::uint64_t seed) {
  constexpr int kAhead = 5, kBehind = 2, kOncoming = 9;
  SceneBuilder builder({}, seed);
  Random& random = builder.random();
  const SharedPath path = addTownRoad(builder, 220.0);
  const auto creeping = [](double delay) {
    return SpeedProfile({{delay, 1.0}, {delay + 2.5, 1.0}, {delay + 3.5, 0.0}, {delay + 6.0, 0.0}, {delay + 7.5, 1.0}})
        .repeat();
  };
  const double start = random.uniform(40.0, 80.0);
  builder.ego(onRightLane(path, start, creeping(0.0)));
  for (int i = -kBehind; i <= kAhead; ++i) {
    const double gap = random.uniform(0.0, 0.6);
    const bool is_ego = i == 0;
    if (!is_ego) builder.add(makeCar(random), onRightLane(path, start + 7.5 * i + gap, creeping(-0.3 * i)));
  }
  Course oncoming;
  oncoming.path = path;
  oncoming.backwards = true;
  oncoming.lateral = kLane;
  const double phase = random.uniform(1.0, 6.0);
  for (int i = 0; i < kOncoming; ++i) {
    oncoming.start = start - 15.0 + 7.5 * i + random.uniform(0.0, 0.6);
    oncoming.speed = creeping(phase - 0.3 * i);
    builder.add(makeCar(random), oncoming);
  }
  Traffic people;
  people.walkers = 20;
  populate(builder, path, people);
  return std::move(builder.scene());
}

Scene makeDoors(std::uint64_t seed) {
  constexpr int kDoors = 8;
  constexpr double kSpeed = 3.0, kApart = 9.0, kRoom = 4.0;  // [m/s], [m], [m]
  SceneBuilder builder({}, seed);
  Random& random = builder.random();
  const double start = random.uniform(10.0, 40.0);
  Roadside roadside;
  std::vector<double> places;
  for (int i = 0; i < kDoors; ++i) {
    places.push_back(start + 10.0 + kApart * i);
    for (const double away : {-kRoom, 0.0, kRoom}) roadside.no_parking.push_back(places.back() + away);
  }
  const SharedPath path = addTownRoad(builder, 220.0, roadside);
  builder.ego(onRightLane(path, start, SpeedProfile(kSpeed)));
  for (int i = 0; i < kDoors; ++i) {
    const double passes = (places[static_cast<std::size_t>(i)] - start) / kSpeed;
    addDoor(builder, *path, places[static_cast<std::size_t>(i)], i % 2 != 0, passes - random.uniform(1.5, 2.8));
  }
  Traffic people;
  people.walkers = 10;
  populate(builder, path, people);
  return std::move(builder.scene());
}

Scene makeLeadVehicle(std::uint64_t seed) {
  SceneBuilder builder({}, seed);
  Random& random = builder.random();
  const SharedPath path = addTownRoad(builder, 320.0);
  const double phase = random.uniform(0.0, 6.28);
  const SpeedProfile speed = swinging(random.uniform(10.0, 13.0), 1.2, 15.0, phase);
  const double start = random.uniform(10.0, 60.0);
  builder.ego(onRightLane(path, start, speed));
  const Model lead = random.chance(0.6) ? makeCar(random) : makeAnyVehicle(random);
  const double half_length = 0.5 * lead.box().sizes().x();
  builder.add(lead, onRightLane(path, start + 3.8 + random.uniform(7.0, 13.0) + half_length, speed));
  addUsualTraffic(builder, path);
  return std::move(builder.scene());
}

Scene makeOncoming(std::uint64_t seed) {
  GroundStyle style;
  style.pavement_width = 0.0;
  style.kerb_height = 0.0;
  style.verge_drop = 0.4;
  SceneBuilder builder(style, seed);
  Random& random = builder.random();
  Roadside roadside;
  roadside.half_width = 4.0;
  roadside.pavement = 0.0;
  roadside.parked = 0.0;
  roadside.trees = 0.5;
  roadside.houses = 0.1;
  const SharedPath path = oval(700.0, 160.0, random.uniform(-3.1, 3.1));
  builder.ground().add({*path, roadside.half_width});
  furnish(builder, *path, 0.0, path->length(), roadside);
  builder.guardRail(*path, 120.0, 320.0, -4.9);
  builder.ego(onRightLane(path, random.uniform(10.0, 200.0), swinging(17.0, 1.0, 13.0, 0.0), 1.9));

  Course course;
  course.path = path;
  course.backwards = true;
  course.lateral = 1.9;
  course.speed = swinging(30.0, 0.5, 9.0, random.uniform(0.0, 6.28));
  for (int i = 0; i < 30; ++i) builder.addClear(makeAnyVehicle(random), course, 25.0);
  return std::move(builder.scene());
}

Scene makeStopAndGo(std::uint64_t seed) {
  SceneBuilder builder({}, seed);
  Random& random = builder.random();
  const SharedPath path = addTownRoad(builder, 220.0);
  const double stop = random.uniform(3.0, 5.0);
  const auto delayed = [&](double delay) {
    return SpeedProfile({{delay, 7.0},
                         {delay + stop, 7.0},
                         {delay + stop + 2.8, 0.0},
                         {delay + stop + 6.5, 0.0},
                         {delay + stop + 10.0, 7.0},
                         {delay + 18.0, 7.0}})
        .repeat();
  };
  const double start = random.uniform(10.0, 60.0);
  builder.ego(onRightLane(path, start, delayed(1.0)));
  const Model lead = makeCar(random);
  builder.add(lead, onRightLane(path, start + 3.8 + random.uniform(4.0, 7.0) + 2.4, delayed(0.0)));

  Course oncoming;
  oncoming.path = path;
  oncoming.backwards = true;
  oncoming.lateral = kLane;
  oncoming.speed = delayed(-random.uniform(1.0, 6.0));
  for (int i = 0; i < 8; ++i) builder.addClear(makeAnyVehicle(random), oncoming, 36.0);
  Traffic people;
  people.walkers = 25;
  populate(builder, path, people);
  return std::move(builder.scene());
}

Scene makeParkedCarLeaves(std::uint64_t seed) {
  SceneBuilder builder({}, seed);
  Random& random = builder.random();
  const double start = random.uniform(10.0, 40.0);
  const double first = start + random.uniform(36.0, 42.0);
  const double second = start + random.uniform(58.0, 66.0);
  const double third = start + random.uniform(95.0, 105.0);
  Roadside roadside;
  roadside.no_parking = {first, first + 8.0, second, second - 8.0, third, third - 8.0};
  const SharedPath path = addTownRoad(builder, 220.0, roadside);
  builder.ego(onRightLane(path, start, swinging(5.0, 0.6, 9.0, 0.0)));
  const Course first_course = pullingOut(path, first, random.uniform(2.5, 3.5), false);
  builder.add(makeCar(random), first_course);
  const Course second_course = pullingOut(path, second, random.uniform(5.0, 6.5), true);
  builder.add(makeCar(random), second_course);
  const Course third_course = pullingOut(path, third, random.uniform(11.0, 13.0), true);
  builder.add(makeVan(random), third_course);
  Traffic people;
  people.walkers = 25;
  populate(builder, path, people);
  return std::move(builder.scene());
}

Scene makeStandstillStart(std::uint64_t seed) {
  SceneBuilder builder({}, seed);
  Random& random = builder.random();
  const SharedPath path = addTownRoad(builder, 220.0);
  const double green = random.uniform(3.0, 5.0);
  const double start = random.uniform(10.0, 60.0);
  builder.ego(onRightLane(path, start, SpeedProfile({{green + 0.8, 0.0}, {green + 5.3, 9.0}})));
  builder.add(makeCar(random), onRightLane(path, start + 11.5, SpeedProfile({{green, 0.0}, {green + 4.2, 9.0}})));
  addUsualTraffic(builder, path);
  addCrossings(builder, *path, 6);
  return std::move(builder.scene());
}

}  // namespace donex::simulation
