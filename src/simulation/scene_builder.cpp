#include "simulation/scene_builder.h"

#include <algorithm>
#include <cmath>

#include "core/pi.h"

namespace donex::simulation {
namespace {

constexpr double kSteelReflectivity = 0.45;

Eigen::Matrix3f turned(double yaw) {
  return Eigen::AngleAxisf(static_cast<float>(yaw), Eigen::Vector3f::UnitZ()).toRotationMatrix();
}

double yawOf(const Eigen::Vector2d& direction) { return std::atan2(direction.y(), direction.x()); }

Eigen::Vector2d footprint(const Model& model) { return 0.5 * model.box().sizes().head<2>(); }

}  // namespace

void SceneBuilder::place(const Eigen::Vector2d& at, double above_ground, const Shape& shape, std::uint32_t label,
                         float reflectivity, float sway) {
  Fixture fixture;
  fixture.center << at, scene_.ground.height(at) + above_ground;
  fixture.shape = shape;
  fixture.label = label;
  fixture.reflectivity = reflectivity;
  fixture.sway = sway;
  scene_.fixtures.push_back(fixture);
}

void SceneBuilder::block(const PathPoint& where, const Eigen::Vector3d& size, std::uint32_t label, float reflectivity,
                         double above_ground) {
  Shape shape;
  shape.axes = turned(where.yaw);
  shape.half = 0.5f * size.cast<float>();
  place(where.position, above_ground + 0.5 * size.z(), shape, label, reflectivity);
}

void SceneBuilder::house(const PathPoint& front, double width, double depth, double height) {
  constexpr double kFoot = 0.5;  // reaches into uneven ground [m]
  const auto brick = static_cast<float>(random_.uniform(0.2, 0.5));
  const auto at = [&](double along, double behind) {
    PathPoint point = front;
    point.position += along * front.forward() - behind * front.left();
    return point;
  };
  block(at(0.0, 0.5 * depth), {width, depth, height + kFoot}, 50, brick, -kFoot);
  block(at(random_.uniform(-0.3, 0.3) * width, -0.35), {1.6, 0.7, 0.3 + kFoot}, 50, brick, -kFoot);
  for (double x = -0.5 * width + 1.2; x < 0.5 * width - 1.0; x += 2.4) {
    block(at(x, -0.08), {1.3, 0.16, 0.12}, 50, brick, 1.0);
    const bool balcony = height > 5.0 && random_.chance(0.3);
    if (balcony) block(at(x, -0.6), {2.0, 1.2, 1.0}, 50, brick, 2.9);
  }
}

void SceneBuilder::leaves(const Eigen::Vector2d& at, double above_ground, const Eigen::Vector3f& half, float pitch,
                          float fill, float sway) {
  Shape shape;
  shape.kind = ShapeKind::kLeaves;
  shape.half = half;
  shape.pitch = pitch;
  shape.fill = fill;
  shape.seed = static_cast<std::uint32_t>(random_.bits());
  place(at, above_ground, shape, 70, 0.35f, sway);
}

void SceneBuilder::tree(const Eigen::Vector2d& at, float sway) {
  const double trunk = random_.uniform(1.9, 2.8);
  const auto crown = static_cast<float>(random_.uniform(1.2, 2.2));
  pole(at, trunk + 1.0, random_.uniform(0.09, 0.22), 71);
  for (int i = 0; i < 3; ++i) {
    const double angle = random_.uniform(0.0, 2.0 * kPi);
    const Eigen::Vector2d offset = 0.45 * crown * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    leaves(at + offset, trunk + crown * (0.5 + 0.35 * i), {crown, crown, 0.75f * crown}, 0.22f, 0.4f, sway);
  }
}

void SceneBuilder::bush(const Eigen::Vector2d& at, double width, double height, float sway) {
  const auto half_width = static_cast<float>(0.5 * width);
  const auto half_height = static_cast<float>(0.55 * height);
  leaves(at, 0.45 * height, {half_width, half_width, half_height}, 0.13f, 0.45f, sway);
}

void SceneBuilder::pole(const Eigen::Vector2d& at, double height, double radius, std::uint32_t label) {
  Shape shape;
  shape.kind = ShapeKind::kCylinder;
  shape.half = Eigen::Vector3d(radius, radius, 0.5 * height + 0.1).cast<float>();
  place(at, 0.5 * height - 0.1, shape, label, 0.3f);
}

void SceneBuilder::sign(const PathPoint& where) {
  pole(where.position, 2.2, 0.04);
  block(where, {0.03, 0.6, 0.6}, 81, 0.9f, 1.9);
}

void SceneBuilder::parked(const PathPoint& where, const Model& model) {
  Course course;
  course.path = std::make_shared<const Path>(Path(where.position, where.yaw).line(1.0));
  const Mover standing{model, course};
  const Eigen::Isometry3d pose = poseOf(standing, scene_.ground, 0.0);
  for (const Part& part : model.posed(0.0)) {
    Fixture fixture;
    fixture.center = pose * part.shape.center.cast<double>();
    fixture.shape = part.shape;
    fixture.shape.axes = pose.linear().cast<float>() * part.shape.axes;
    fixture.label = model.object_class.at_rest;
    fixture.reflectivity = part.reflectivity;
    scene_.fixtures.push_back(fixture);
  }
}

void SceneBuilder::slats(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double height) {
  Shape shape;
  shape.kind = ShapeKind::kSlats;
  shape.axes = turned(yawOf(to - from));
  shape.half = Eigen::Vector3d(0.5 * (to - from).norm(), 1.0, 0.5 * height).cast<float>();
  shape.pitch = 0.16f;
  shape.fill = 0.55f;
  place(0.5 * (from + to), 0.5 * height + 0.06, shape, 51, 0.3f);
}

void SceneBuilder::wall(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double height, std::uint32_t label) {
  const PathPoint middle{0.5 * (from + to), yawOf(to - from), 0.0};
  block(middle, {(to - from).norm(), 0.25, height + 0.3}, label, 0.35f, -0.3);
}

void SceneBuilder::guardRail(const Path& path, double from, double to, double lateral) {
  constexpr double kPost = 4.0;  // [m]
  for (double s = from; s < to; s += kPost) {
    const auto steel = static_cast<float>(kSteelReflectivity);
    block(path.at(s, lateral), {0.1, 0.06, 0.75}, 51, steel);
    const double facing = lateral > 0.0 ? -0.07 : 0.07;
    block(path.at(s + 0.5 * kPost, lateral + facing), {kPost, 0.05, 0.31}, 51, steel, 0.44);
  }
}

void SceneBuilder::hedge(const Path& path, double from, double to, double lateral, double height, float sway) {
  for (double s = from; s < to; s += 0.75 * height) {
    bush(path.at(s, lateral + random_.uniform(-0.1, 0.1)).position, 1.15 * height, height, sway);
  }
}

void SceneBuilder::picketFence(const Path& path, double from, double to, double lateral, double height) {
  constexpr double kPanel = 3.0;  // [m]
  for (double s = from; s < to; s += kPanel) {
    const Eigen::Vector2d start = path.at(s, lateral).position;
    const Eigen::Vector2d end = path.at(s + kPanel, lateral).position;
    slats(start, end, height);
    block(path.at(s, lateral), {0.09, 0.09, height + 0.12}, 51, 0.3f);
    for (const double up : {0.25, 0.85 * height}) {
      block({0.5 * (start + end), yawOf(end - start), 0.0}, {kPanel, 0.03, 0.07}, 51, 0.3f, up);
    }
  }
}

void SceneBuilder::bridge(const Path& path, double s, double half_span, double clearance, double width) {
  constexpr double kStrip = 4.0;  // [m]
  const double base = scene_.ground.height(path.at(s).position);
  const auto above_ground = [&](const PathPoint& at) { return base + clearance - scene_.ground.height(at.position); };
  for (double across = -half_span; across <= half_span; across += kStrip) {
    const PathPoint at = path.at(s, across);
    block(at, {width, kStrip, 0.9}, 52, 0.35f, above_ground(at));
    for (const double edge : {-0.5, 0.5}) {
      PathPoint parapet = at;
      parapet.position += edge * width * at.forward();
      block(parapet, {0.2, kStrip, 1.0}, 52, 0.35f, above_ground(at) + 0.9);
    }
  }
  for (const double side : {-1.0, 1.0}) {
    const PathPoint at = path.at(s, side * (half_span - kStrip));
    for (const double along : {-0.3, 0.3}) pole(at.position + along * width * at.forward(), clearance, 0.4, 52);
  }
}

void SceneBuilder::ego(const Course& course) {
  scene_.ego.course = course;
  ego_track_ = trackOf(course, {3.0, 1.0});
  Eigen::Isometry3d& mounting = scene_.ego.base_from_sensor;
  mounting = Eigen::Translation3d(1.1, 0.0, 1.73);
  mounting.rotate(Eigen::AngleAxisd(0.004, Eigen::Vector3d::UnitX()));
  mounting.rotate(Eigen::AngleAxisd(0.006, Eigen::Vector3d::UnitY()));
}

void SceneBuilder::add(const Model& model, const Course& course) {
  scene_.movers.push_back({model, course});
  tracks_.push_back(trackOf(course, footprint(model)));
}

bool SceneBuilder::addClear(const Model& model, Course course, double horizon) {
  constexpr int kAttempts = 25;
  const Eigen::Vector2d half = footprint(model);
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    course.start = random_.uniform(0.0, course.path->length());
    const Track track = trackOf(course, half);
    const auto meets = [&](const Track& other) { return !stayClear(track, other, horizon); };
    if (meets(ego_track_) || std::any_of(tracks_.begin(), tracks_.end(), meets)) continue;
    scene_.movers.push_back({model, course});
    tracks_.push_back(track);
    return true;
  }
  return false;
}

SharedPath oval(double straight, double radius, double yaw) {
  Path path({0.0, 0.0}, yaw);
  for (int i = 0; i < 2; ++i) path.line(straight).arc(radius, kPi);
  return std::make_shared<const Path>(path.wrap());
}

SharedPath crossing(const PathPoint& middle, double half_length) {
  const PathPoint across{middle.position - half_length * middle.left(), middle.yaw + 0.5 * kPi, 0.0};
  Path path(across.position, across.yaw);
  path.line(2.0 * half_length).arc(0.7, kPi).line(2.0 * half_length).arc(0.7, kPi).wrap();
  return std::make_shared<const Path>(path);
}

SpeedProfile swinging(double mean, double swing, double period, double phase) {
  std::vector<SpeedProfile::Knot> knots;
  constexpr int kKnots = 16;
  for (int i = 0; i <= kKnots; ++i) {
    const double angle = 2.0 * kPi * i / kKnots;
    knots.push_back({period * i / kKnots, mean + swing * std::sin(angle + phase)});
  }
  return SpeedProfile(knots).repeat();
}

}  // namespace donex::simulation
