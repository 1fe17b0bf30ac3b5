#include "simulation/model.h"

#include <cmath>

namespace donex::simulation {
namespace {

using Eigen::Vector3f;

constexpr float kGlass = 0.12f;
constexpr float kRubber = 0.08f;
constexpr float kSkin = 0.35f;
constexpr float kDark = 0.15f;

/// A box by its two corners.
Part box(const Vector3f& low, const Vector3f& high, float reflectivity) {
  Shape shape;
  shape.center = 0.5f * (low + high);
  shape.half = 0.5f * (high - low);
  return {shape, reflectivity};
}

/// A sheet across the vehicle that leans from (x, z) to (x, z), `width` wide.
Part sheet(const Eigen::Vector2f& from, const Eigen::Vector2f& to, float width) {
  const Eigen::Vector2f along = to - from;
  Shape shape;
  shape.center = {0.5f * (from.x() + to.x()), 0.0f, 0.5f * (from.y() + to.y())};
  shape.axes = Eigen::AngleAxisf(-std::atan2(along.y(), along.x()), Vector3f::UnitY()).toRotationMatrix();
  shape.half = {0.5f * along.norm(), 0.5f * width, 0.02f};
  return {shape, kGlass};
}

Part limb(const Vector3f& from, const Vector3f& to, float radius, float reflectivity) {
  const Vector3f along = to - from;
  Shape shape;
  shape.kind = ShapeKind::kCylinder;
  shape.center = 0.5f * (from + to);
  const auto turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), along.cast<double>());
  shape.axes = turn.normalized().toRotationMatrix().cast<float>();
  shape.half = {radius, radius, 0.5f * along.norm()};
  return {shape, reflectivity};
}

Part ball(const Vector3f& center, const Vector3f& half, float reflectivity, float lean = 0.0f) {
  Shape shape;
  shape.kind = ShapeKind::kEllipsoid;
  shape.center = center;
  shape.half = half;
  shape.axes = Eigen::AngleAxisf(lean, Vector3f::UnitY()).toRotationMatrix();
  return {shape, reflectivity};
}

void addWheels(Model& model, float x, float half_track, float radius, float half_width) {
  for (const float side : {-1.0f, 1.0f}) {
    const float y = side * (half_track - half_width);
    model.parts.push_back(limb({x, y - half_width, radius}, {x, y + half_width, radius}, radius, kRubber));
  }
}

float paint(Random& random) { return static_cast<float>(random.uniform(0.12, 0.6)); }

void addWalkingLimbs(std::vector<Part>& parts, double stature, double way) {
  const auto h = static_cast<float>(stature);
  const auto swing = static_cast<float>(std::sin(way * 6.2832 / (0.82 * stature)));
  for (const float side : {-1.0f, 1.0f}) {
    const float leg = 0.45f * side * swing;
    const float arm = -0.5f * side * swing;
    const Vector3f hip(0.0f, 0.095f * side * h, 0.5f * h);
    const Vector3f shoulder(0.0f, 0.125f * side * h, 0.81f * h);
    parts.push_back(limb(hip, hip + 0.49f * h * Vector3f(std::sin(leg), 0.0f, -std::cos(leg)), 0.045f * h, kDark));
    parts.push_back(
        limb(shoulder, shoulder + 0.4f * h * Vector3f(std::sin(arm), 0.08f * side, -std::cos(arm)), 0.028f * h, kSkin));
  }
}

void addPedallingLimbs(std::vector<Part>& parts, double way) {
  for (const float side : {-1.0f, 1.0f}) {
    const auto turn = static_cast<float>(-way * 6.2832 / 5.0) + (side > 0.0f ? 3.1416f : 0.0f);
    const Vector3f hip(-0.2f, 0.1f * side, 0.98f);
    const Vector3f foot(0.08f + 0.17f * std::cos(turn), 0.12f * side, 0.3f + 0.17f * std::sin(turn));
    const Vector3f knee = 0.5f * (hip + foot) + Vector3f(0.2f, 0.02f * side, 0.08f);
    parts.push_back(limb(hip, knee, 0.075f, kDark));
    parts.push_back(limb(knee, foot, 0.055f, kDark));
  }
}

}  // namespace

std::vector<Part> Model::posed(double way) const {
  std::vector<Part> all = parts;
  if (gait == Gait::kWalk) addWalkingLimbs(all, stature, way);
  if (gait == Gait::kPedal) addPedallingLimbs(all, way);
  return all;
}

Eigen::AlignedBox3d Model::box() const {
  Eigen::AlignedBox3d result;
  for (int i = 0; i < 40; ++i) {
    for (const Part& part : posed(0.125 * i)) {
      const Shape& shape = part.shape;
      const Vector3f reach = (shape.axes * shape.half.asDiagonal()).cwiseAbs().rowwise().sum();
      result.extend((shape.center - reach).cast<double>());
      result.extend((shape.center + reach).cast<double>());
    }
  }
  return result;
}

Model makeCar(Random& random) {
  Model model;
  const int shape = random.below(3);  // hatchback, saloon, off-roader
  const auto vary = [&](double value, double by) { return static_cast<float>(value + random.uniform(-by, by)); };
  const float length = vary(shape == 0 ? 3.9 : shape == 1 ? 4.6 : 4.7, 0.2);
  const float half_width = 0.5f * vary(shape == 2 ? 1.9 : 1.78, 0.05);
  const float height = vary(shape == 2 ? 1.7 : 1.46, 0.04);
  const float belt = 0.6f * height;
  const float front = 0.5f * length;
  const float colour = paint(random);
  const float roof_front = front - 0.43f * length;
  const float roof_rear = shape == 1 ? -front + 0.26f * length : -front + 0.09f * length;
  const float tail = shape == 1 ? -front + 0.13f * length : -front + 0.02f * length;
  const float clear = shape == 2 ? 0.3f : 0.2f;
  const float cabin = 0.82f * half_width;
  auto& parts = model.parts;
  parts.push_back(box({-front, -half_width, clear}, {front, half_width, 0.45f * height}, colour));
  parts.push_back(
      box({-front + 0.06f, -half_width + 0.03f, 0.45f * height}, {front - 0.12f, half_width - 0.03f, belt}, colour));
  parts.push_back(box({roof_rear, -cabin, belt}, {roof_front, cabin, height}, colour));
  parts.push_back(sheet({roof_front + 0.16f * length, belt}, {roof_front, height}, 2.0f * cabin));
  parts.push_back(sheet({roof_rear, height}, {tail, belt}, 2.0f * cabin));
  for (const float side : {-1.0f, 1.0f}) {
    const float x = roof_front + 0.06f * length;
    parts.push_back(
        box({x, side * half_width - 0.09f, belt}, {x + 0.1f, side * half_width + 0.09f, belt + 0.14f}, colour));
  }
  addWheels(model, 0.3f * length, half_width, 0.22f * height, 0.1f);
  addWheels(model, -0.3f * length, half_width, 0.22f * height, 0.1f);
  return model;
}

Model makeVan(Random& random) {
  Model model;
  const auto half_length = static_cast<float>(random.uniform(2.5, 3.0));
  const auto height = static_cast<float>(random.uniform(2.0, 2.6));
  const float colour = paint(random);
  auto& parts = model.parts;
  parts.push_back(box({-half_length, -0.98f, 0.3f}, {half_length - 1.3f, 0.98f, height}, colour));
  parts.push_back(box({half_length - 1.3f, -0.95f, 0.3f}, {half_length, 0.95f, 1.15f}, colour));
  parts.push_back(sheet({half_length - 0.45f, 1.15f}, {half_length - 1.3f, height}, 1.8f));
  addWheels(model, half_length - 0.9f, 0.97f, 0.34f, 0.11f);
  addWheels(model, -half_length + 1.0f, 0.97f, 0.34f, 0.11f);
  return model;
}

Model makeLorry(Random& random) {
  Model model;
  model.object_class = kLorry;
  const bool with_trailer = random.chance(0.5);
  const auto half_length = static_cast<float>(with_trailer ? random.uniform(7.5, 8.2) : random.uniform(3.8, 4.8));
  const float colour = paint(random);
  const float wheel = 0.5f;
  auto& parts = model.parts;
  parts.push_back(box({half_length - 2.1f, -1.22f, 0.45f}, {half_length, 1.22f, 3.0f}, paint(random)));
  parts.push_back(box({-half_length, -1.27f, 1.15f}, {half_length - 2.6f, 1.27f, 3.8f}, colour));
  parts.push_back(box({-half_length + 0.3f, -0.45f, 0.75f}, {half_length - 2.0f, 0.45f, 1.15f}, kDark));
  parts.push_back(box({-half_length, -1.15f, 0.5f}, {-half_length + 0.1f, 1.15f, 0.65f}, kDark));
  addWheels(model, half_length - 1.3f, 1.22f, wheel, 0.16f);
  addWheels(model, -half_length + 1.4f, 1.22f, wheel, 0.28f);
  if (with_trailer) {
    addWheels(model, half_length - 4.6f, 1.22f, wheel, 0.28f);
    addWheels(model, -half_length + 2.7f, 1.22f, wheel, 0.28f);
    addWheels(model, -half_length + 4.0f, 1.22f, wheel, 0.28f);
  }
  return model;
}

Model makeBus(Random& random) {
  Model model;
  model.object_class = kBus;
  const float colour = paint(random);
  auto& parts = model.parts;
  parts.push_back(box({-6.0f, -1.27f, 0.32f}, {6.0f, 1.27f, 1.2f}, colour));
  parts.push_back(box({-5.98f, -1.24f, 1.2f}, {5.98f, 1.24f, 2.5f}, kGlass));
  parts.push_back(box({-6.0f, -1.27f, 2.5f}, {6.0f, 1.27f, 3.05f}, colour));
  addWheels(model, 3.3f, 1.25f, 0.48f, 0.14f);
  addWheels(model, -2.9f, 1.25f, 0.48f, 0.28f);
  return model;
}

Model makePerson(Random& random) {
  Model model;
  model.object_class = kPerson;
  model.gait = Gait::kWalk;
  model.stature = random.chance(0.15) ? random.uniform(1.1, 1.4) : random.uniform(1.58, 1.9);
  const auto h = static_cast<float>(model.stature);
  const auto wide = static_cast<float>(random.uniform(0.9, 1.15));
  model.parts.push_back(ball({0.0f, 0.0f, 0.66f * h}, {0.075f * wide * h, 0.13f * wide * h, 0.19f * h}, paint(random)));
  model.parts.push_back(ball({0.01f, 0.0f, 0.93f * h}, {0.058f * h, 0.05f * h, 0.07f * h}, kSkin));
  return model;
}

Model makeCyclist(Random& random) {
  Model model;
  model.object_class = kCyclist;
  model.gait = Gait::kPedal;
  const float colour = paint(random);
  auto& parts = model.parts;
  for (const float x : {-0.52f, 0.52f}) parts.push_back(limb({x, -0.025f, 0.34f}, {x, 0.025f, 0.34f}, 0.34f, kRubber));
  parts.push_back(limb({-0.52f, 0.0f, 0.34f}, {-0.2f, 0.0f, 0.9f}, 0.025f, kDark));
  parts.push_back(limb({-0.1f, 0.0f, 0.32f}, {0.42f, 0.0f, 0.85f}, 0.025f, kDark));
  parts.push_back(limb({0.52f, 0.0f, 0.34f}, {0.4f, 0.0f, 1.02f}, 0.025f, kDark));
  parts.push_back(limb({0.36f, -0.28f, 1.03f}, {0.36f, 0.28f, 1.03f}, 0.02f, kDark));
  parts.push_back(ball({-0.03f, 0.0f, 1.28f}, {0.14f, 0.2f, 0.34f}, colour, 0.5f));
  parts.push_back(ball({0.22f, 0.0f, 1.69f}, {0.12f, 0.09f, 0.13f}, kSkin));
  for (const float side : {-1.0f, 1.0f}) {
    parts.push_back(limb({0.1f, 0.19f * side, 1.48f}, {0.36f, 0.26f * side, 1.05f}, 0.045f, colour));
  }
  return model;
}

}  // namespace donex::simulation
