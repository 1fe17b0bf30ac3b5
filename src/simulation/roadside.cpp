#include "simulation/roadside.h"

#include <cmath>

#include "core/pi.h"

namespace donex::simulation {
namespace {

/// One side of a road, seen from its middle: `side` 1 is left, -1 right.
class Side {
 public:
  Side(SceneBuilder& builder, const Path& path, const Roadside& style, double side)
      : builder_(builder), random_(builder.random()), path_(path), style_(style), side_(side) {}

  void furnish(double from, double to) {
    every(6.3, style_.parked, from, to, [this](double s) { parkVehicle(s); });
    every(11.0, style_.trees, from, to, [this](double s) { plantTree(s); });
    every(28.0, 1.0, from + 5.0, to, [this](double s) { pavementThing(s); });
    every(5.0, style_.bushes, from, to, [this](double s) { plantBush(s); });
    double width = 0.0;
    for (double s = from + 2.0; s < to; s += width + random_.uniform(1.5, 6.0)) {
      width = random_.uniform(8.0, 14.0);
      if (random_.chance(style_.houses)) plot(s, width);
    }
  }

 private:
  template <class Action>
  void every(double step, double chance, double from, double to, Action&& action) {
    if (chance == 0.0) return;
    for (double s = from; s < to; s += step) {
      if (random_.chance(chance)) action(s);
    }
  }

  PathPoint beside(double s, double beyond_edge) const {
    PathPoint point = path_.at(s, side_ * (style_.half_width + beyond_edge));
    if (side_ > 0.0) point.yaw += kPi;
    return point;
  }

  /// No other road is nearer than this one's edge says.
  bool isFree(double s, double beyond_edge) const {
    return builder_.ground().beyondEdge(beside(s, beyond_edge).position) > beyond_edge - 0.3;
  }

  void parkVehicle(double s) {
    constexpr double kInside = -1.15;  // [m]
    if (!isFree(s - 3.0, kInside) || !isFree(s + 3.0, kInside)) return;
    for (const double reserved : style_.no_parking) {
      if (std::abs(s - reserved) < 7.0) return;
    }
    const Model model = random_.chance(0.12) ? makeVan(random_) : makeCar(random_);
    const double lateral = random_.uniform(-0.1, 0.1);
    const double along = random_.uniform(-0.3, 0.3);
    PathPoint place = beside(s + along, kInside + lateral);
    const double skew = random_.uniform(-0.03, 0.03);
    const bool faces_back = random_.chance(0.2);
    place.yaw += skew + (faces_back ? kPi : 0.0);
    builder_.parked(place, model);
  }

  void plantTree(double s) {
    const double at = style_.pavement > 0.0 ? 0.6 : 2.5;
    if (isFree(s, at)) builder_.tree(beside(s, at).position, style_.sway);
  }

  void pavementThing(double s) {
    if (!isFree(s, 0.5)) return;
    const PathPoint place = beside(s, 0.5);
    switch (random_.below(3)) {
      case 0: return builder_.pole(place.position, 6.0, 0.08);
      case 1: return builder_.sign(place);
      default: return builder_.block(place, {0.5, 0.4, 1.1}, 99, 0.3f);
    }
  }

  void plantBush(double s) {
    const double at = style_.pavement + random_.uniform(0.8, 3.0);
    if (!isFree(s, at)) return;
    const double width = random_.uniform(0.8, 2.0);
    builder_.bush(beside(s, at).position, width, random_.uniform(0.7, 1.1) * width, style_.sway);
  }

  void plot(double s, double width) {
    const double front = style_.pavement + random_.uniform(0.3, 4.5);
    const double depth = random_.uniform(7.0, 10.0);
    const double middle = s + 0.5 * width;
    const bool enough_room = isFree(s - 1.0, front) && isFree(s + width + 1.0, front) &&
                             isFree(s - 1.0, front + depth) && isFree(s + width + 1.0, front + depth);
    if (!enough_room) return;
    builder_.house(beside(middle, front), width, depth, random_.uniform(4.5, 11.0));
    const bool has_garden = front > style_.pavement + 1.5 && random_.chance(style_.gardens);
    if (has_garden) enclose(s, s + width);
  }

  void enclose(double from, double to) {
    const double lateral = side_ * (style_.half_width + style_.pavement + 0.3);
    const double gate = random_.uniform(from + 1.0, to - 2.5);
    switch (random_.below(3)) {
      case 0:
        builder_.picketFence(path_, from, gate - 2.0, lateral, 1.0);
        return builder_.picketFence(path_, gate + 1.4, to - 2.0, lateral, 1.0);
      case 1:
        builder_.hedge(path_, from, gate, lateral, 1.2, style_.sway);
        return builder_.hedge(path_, gate + 2.0, to, lateral, 1.2, style_.sway);
      default:
        builder_.wall(path_.at(from, lateral).position, path_.at(gate, lateral).position, 0.9);
        return builder_.wall(path_.at(gate + 1.4, lateral).position, path_.at(to, lateral).position, 0.9);
    }
  }

  SceneBuilder& builder_;
  Random& random_;
  const Path& path_;
  const Roadside& style_;
  double side_;
};

}  // namespace

void furnish(SceneBuilder& builder, const Path& path, double from, double to, const Roadside& roadside) {
  for (const double side : {-1.0, 1.0}) Side(builder, path, roadside, side).furnish(from, to);
}

void addCrossings(SceneBuilder& builder, const Path& path, int count, double slowest, double fastest) {
  Random& random = builder.random();
  for (int i = 0; i < count; ++i) {
    Course course;
    course.path = crossing(path.at(random.uniform(0.0, path.length())), 6.0);
    course.speed = SpeedProfile(random.uniform(slowest, fastest));
    builder.addClear(makePerson(random), course);
  }
}

Model makeAnyVehicle(Random& random) {
  const double kind = random.uniform();
  if (kind < 0.75) return makeCar(random);
  if (kind < 0.92) return makeVan(random);
  return makeLorry(random);
}

Course onRightLane(const SharedPath& path, double start, const SpeedProfile& speed, double lane) {
  Course course;
  course.path = path;
  course.start = start;
  course.lateral = -lane;
  course.speed = speed;
  return course;
}

void populate(SceneBuilder& builder, const SharedPath& path, const Traffic& traffic, double horizon) {
  Random& random = builder.random();
  Course course;
  course.path = path;
  course.backwards = true;
  course.lateral = traffic.lane;
  course.speed = swinging(traffic.oncoming_speed, 0.08 * traffic.oncoming_speed, 11.0, random.uniform(0.0, 6.28));
  for (int i = 0; i < traffic.oncoming; ++i) builder.addClear(makeAnyVehicle(random), course, horizon);
  for (int i = 0; i < traffic.cyclists; ++i) {
    course.backwards = random.chance(0.5);
    course.lateral = (course.backwards ? 1.0 : -1.0) * (traffic.lane + 1.5);
    const double phase = random.uniform(0.0, 6.28);
    course.speed = swinging(random.uniform(3.5, 6.0), 0.4, 7.0, phase);
    builder.addClear(makeCyclist(random), course, horizon);
  }
  for (int i = 0; i < traffic.walkers; ++i) {
    course.backwards = random.chance(0.5);
    const double side = random.chance(0.5) ? 1.0 : -1.0;
    course.lateral = side * (traffic.pavement + random.uniform(-0.5, 0.7));
    course.speed = SpeedProfile(random.uniform(traffic.slowest, traffic.fastest));
    builder.addClear(makePerson(random), course, horizon);
  }
}

}  // namespace donex::simulation
