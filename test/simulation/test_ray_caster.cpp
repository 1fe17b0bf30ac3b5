// The fast answer against asking every target.
#include <gtest/gtest.h>

#include "random_shapes.h"
#include "simulation/ray_caster.h"

namespace donex::simulation {
namespace {

std::vector<Target> randomTargets(Random& random, int count, bool moving) {
  std::vector<Target> targets;
  for (int i = 0; i < count; ++i) {
    Target target;
    target.shape = randomShape(random, kAllKinds[random.below(5)], 25.0);
    target.shape.center.z() *= 0.15f;
    if (random.chance(0.1)) target.shape.half.x() *= 15.0f;  // walls
    if (target.shape.kind == ShapeKind::kCylinder) target.shape.half.y() = target.shape.half.x();
    if (moving) {
      target.velocity = randomVector(random, 20.0);
      target.time = static_cast<float>(random.uniform(-0.1, 0.0));
    }
    targets.push_back(target);
  }
  return targets;
}

Eigen::Isometry3f randomPose(Random& random, double turn) {
  Eigen::Isometry3f pose = Eigen::Isometry3f::Identity();
  pose.translation() = randomVector(random, 3.0);
  pose.rotate(Eigen::AngleAxisf(static_cast<float>(random.uniform(-3.0, 3.0)), Eigen::Vector3f::UnitZ()));
  pose.rotate(Eigen::AngleAxisf(static_cast<float>(turn), randomVector(random, 1.0).normalized()));
  return pose;
}

Hit askAll(const std::vector<Target>& targets, const SensorModel& model, const Eigen::Isometry3f& sensor, float time,
           int column, std::size_t beam, float limit) {
  const Eigen::Vector2f heading = model.headings[static_cast<std::size_t>(column)].cast<float>();
  const Eigen::Matrix3f axes = sensor.linear();
  const Eigen::Vector3f forward = axes.leftCols<2>() * heading;
  Hit best{limit, kNoTarget};
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const Eigen::Vector3f origin = sensor.translation() - targets[i].velocity * (time - targets[i].time);
    const float parameter = intersect(targets[i].shape, {origin, forward + model.slopes[beam] * axes.col(2)});
    if (parameter < best.parameter) best = {parameter, static_cast<int>(i)};
  }
  return best;
}

/// The sensor's pose at a fraction of the stretch, from -1 to 1.
Eigen::Isometry3f during(const Stretch& stretch, float fraction, const Eigen::Vector3f& movement,
                         const Eigen::Vector3f& axis) {
  Eigen::Isometry3f pose = stretch.sensor;
  pose.translation() += fraction * movement;
  pose.rotate(Eigen::AngleAxisf(fraction * stretch.rotation, axis));
  return pose;
}

void compare(std::uint64_t seed, bool moving, int& hits) {
  Random random(seed);
  const SensorModel model = makeSensorModel(16);
  const std::vector<Target> targets = randomTargets(random, 120, moving);
  const Eigen::Vector3f movement = moving ? randomVector(random, 0.1) : Eigen::Vector3f::Zero();
  const Eigen::Vector3f axis = randomVector(random, 1.0).normalized();
  Stretch stretch{0, model.columns(), randomPose(random, 0.05), 0.0f, 0.0f, 0.0f, 0.0f};
  if (moving) {
    stretch.first_column = model.columns() / 12 * random.below(12);
    stretch.end_column = stretch.first_column + model.columns() / 12;
    stretch.time = -0.05f;
    stretch.half_duration = 0.004f;
    stretch.movement = movement.norm();
    stretch.rotation = 0.005f;
  }
  RayCaster caster(model);
  caster.prepare(targets, stretch);
  for (int column = stretch.first_column; column < stretch.end_column; column += moving ? 1 : 11) {
    const auto fraction = static_cast<float>(random.uniform(-1.0, 1.0));
    const Eigen::Isometry3f sensor = moving ? during(stretch, fraction, movement, axis) : stretch.sensor;
    const float time = stretch.time + fraction * stretch.half_duration;
    const float limit = random.chance(0.3) ? 9.0f : kMiss;
    std::vector<Hit> found(model.slopes.size(), Hit{limit, kNoTarget});
    caster.cast(column, sensor, time, found);
    for (std::size_t beam = 0; beam < found.size(); ++beam) {
      const Hit expected = askAll(targets, model, sensor, time, column, beam, limit);
      ASSERT_EQ(found[beam].parameter, expected.parameter)
          << "seed " << seed << " column " << column << " beam " << beam;
      hits += expected.target != kNoTarget ? 1 : 0;
    }
  }
}

TEST(RayCaster, FindsWhatAskingEveryTargetFinds) {
  int hits = 0;
  for (std::uint64_t seed = 0; seed < 25; ++seed) compare(seed, false, hits);
  EXPECT_GT(hits, 5000);
}

TEST(RayCaster, FindsItWhileSensorAndTargetsMove) {
  int hits = 0;
  for (std::uint64_t seed = 100; seed < 140; ++seed) compare(seed, true, hits);
  EXPECT_GT(hits, 5000);
}

}  // namespace
}  // namespace donex::simulation
