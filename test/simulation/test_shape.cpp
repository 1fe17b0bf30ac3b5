#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "random_shapes.h"
#include "simulation/shape.h"

namespace donex::simulation {
namespace {

/// At most 0 inside, in units of the solid's size; said without any ray.
double implicitValue(const Shape& shape, const Eigen::Vector3d& world) {
  const Eigen::Vector3d p = shape.axes.cast<double>().transpose() * (world - shape.center.cast<double>());
  const Eigen::Vector3d relative = p.cwiseQuotient(shape.half.cast<double>());
  switch (shape.kind) {
    case ShapeKind::kBox: return relative.cwiseAbs().maxCoeff() - 1.0;
    case ShapeKind::kCylinder: return std::max(relative.head<2>().norm(), std::abs(relative.z())) - 1.0;
    default: return relative.norm() - 1.0;
  }
}

struct Marched {
  double enter = INFINITY;
  bool grazes = false;  // comes so close to the surface that a step may have missed it
};

/// Small steps along the ray until it is inside.
Marched march(const Shape& shape, const Ray& ray, double reach) {
  constexpr double kStep = 0.002;
  Marched result;
  for (double t = kStep; t < reach; t += kStep) {
    const double value = implicitValue(shape, (ray.origin + static_cast<float>(t) * ray.direction).cast<double>());
    if (value <= 0.0) {
      result.enter = t;
      return result;
    }
    result.grazes = result.grazes || value < 0.03;
  }
  return result;
}

/// From outside towards the neighbourhood of the shape.
Ray rayTowards(Random& random, const Shape& shape) {
  const Eigen::Vector3f origin = shape.center + 3.0f * randomVector(random, 1.0).normalized();
  return {origin, (shape.center + randomVector(random, 1.2) - origin).normalized()};
}

class Solids : public testing::TestWithParam<ShapeKind> {};

TEST_P(Solids, AreEnteredWhereMarchingEntersThem) {
  Random random(7);
  int hits = 0;
  int misses = 0;
  for (int i = 0; i < 600; ++i) {
    const Shape shape = randomShape(random, GetParam(), 5.0);
    const Ray ray = rayTowards(random, shape);
    if (implicitValue(shape, ray.origin.cast<double>()) < 0.1) continue;
    const float parameter = intersect(shape, ray);
    const Marched expected = march(shape, ray, 6.0);
    if (std::isinf(expected.enter)) {
      EXPECT_TRUE(parameter == kMiss || expected.grazes) << i;
      ++misses;
    } else {
      EXPECT_NEAR(parameter, expected.enter, expected.grazes ? 0.05 : 0.004) << i;
      ++hits;
    }
  }
  EXPECT_GT(hits, 100);
  EXPECT_GT(misses, 20);
}

TEST_P(Solids, NormalPointsOutwardsAndAgainstTheRay) {
  Random random(8);
  int hits = 0;
  for (int i = 0; i < 400; ++i) {
    const Shape shape = randomShape(random, GetParam(), 5.0);
    const Ray ray = rayTowards(random, shape);
    const float parameter = intersect(shape, ray);
    if (parameter == kMiss) continue;
    const Eigen::Vector3f point = ray.origin + parameter * ray.direction;
    const Eigen::Vector3f normal = normalAt(shape, point, ray.direction);
    EXPECT_NEAR(normal.norm(), 1.0, 1e-4);
    EXPECT_LT(normal.dot(ray.direction), 1e-2);
    EXPECT_GT(implicitValue(shape, (point + 0.05f * normal).cast<double>()), 0.0);
    ++hits;
  }
  EXPECT_GT(hits, 100);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Solids, testing::Values(ShapeKind::kBox, ShapeKind::kCylinder, ShapeKind::kEllipsoid));

/// All leaves of the crown, one by one.
float nearestLeaf(const Shape& shape, const Ray& world) {
  const Ray ray = shape.toLocal(world);
  const Eigen::Vector3i reach = (shape.half / shape.pitch).array().ceil().matrix().cast<int>();
  float nearest = kMiss;
  for (int x = -reach.x() - 1; x <= reach.x(); ++x) {
    for (int y = -reach.y() - 1; y <= reach.y(); ++y) {
      for (int z = -reach.z() - 1; z <= reach.z(); ++z) {
        const Leaf leaf = leafOf(shape, {x, y, z});
        if (leaf.radius == 0.0f) continue;
        Shape ball;
        ball.kind = ShapeKind::kEllipsoid;
        ball.center = leaf.center;
        ball.half = Eigen::Vector3f::Constant(leaf.radius);
        const float parameter = intersect(ball, ray);
        if (parameter == kMiss) continue;
        const Eigen::Vector3f local = ray.origin + parameter * ray.direction;
        const bool in_crown = local.cwiseQuotient(shape.half).norm() < 1.0f;
        if (in_crown) nearest = std::min(nearest, parameter);
      }
    }
  }
  return nearest;
}

TEST(Leaves, NearestOfAllIsFound) {
  Random random(9);
  int hits = 0;
  int through = 0;
  for (int i = 0; i < 900; ++i) {
    const Shape shape = randomShape(random, ShapeKind::kLeaves, 5.0);
    const Ray ray = rayTowards(random, shape);
    const float expected = nearestLeaf(shape, ray);
    const float parameter = intersect(shape, ray);
    if (expected == kMiss || parameter == kMiss) {
      EXPECT_EQ(parameter, expected) << i;
      ++through;
    } else {
      EXPECT_NEAR(parameter, expected, 1e-3) << i;
      ++hits;
    }
  }
  EXPECT_GT(hits, 60);
  EXPECT_GT(through, 60);
}

TEST(Leaves, LieWhollyInsideTheirCells) {
  Random random(10);
  const Shape shape = randomShape(random, ShapeKind::kLeaves, 0.0);
  int leaves = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3i cell(random.below(40) - 20, random.below(40) - 20, random.below(40) - 20);
    const Leaf leaf = leafOf(shape, cell);
    if (leaf.radius == 0.0f) continue;
    const Eigen::Vector3f low = cell.cast<float>() * shape.pitch;
    EXPECT_GE((leaf.center - low).minCoeff(), leaf.radius - 1e-5f);
    EXPECT_LE((leaf.center - low).maxCoeff(), shape.pitch - leaf.radius + 1e-5f);
    ++leaves;
  }
  EXPECT_NEAR(leaves / 2000.0, shape.fill, 0.05);
}

TEST(Slats, StopTheFractionOfRaysThatTheyCover) {
  Shape shape;
  shape.kind = ShapeKind::kSlats;
  shape.half = {2.0f, 1.0f, 1.0f};
  shape.pitch = 0.16f;
  shape.fill = 0.55f;
  Random random(11);
  int stopped = 0;
  constexpr int kRays = 4000;
  for (int i = 0; i < kRays; ++i) {
    const auto x = static_cast<float>(random.uniform(-1.92, 1.92));
    const Ray ray{{x, -3.0f, 0.0f}, {0.0f, 2.0f, 0.1f}};
    const float parameter = intersect(shape, ray);
    if (parameter == kMiss) continue;
    EXPECT_NEAR(parameter, 1.5f, 1e-5);
    ++stopped;
  }
  EXPECT_NEAR(static_cast<double>(stopped) / kRays, 0.55, 0.03);
}

TEST(Shapes, AreNotHitBeyondTheLimitNorBehindTheOrigin) {
  Random random(12);
  for (int i = 0; i < 500; ++i) {
    const Shape shape = randomShape(random, kAllKinds[random.below(5)], 5.0);
    const Ray ray = rayTowards(random, shape);
    const float parameter = intersect(shape, ray);
    if (parameter == kMiss) continue;
    EXPECT_GT(parameter, 0.0f);
    EXPECT_EQ(intersect(shape, ray, 0.999f * parameter), kMiss);
    EXPECT_EQ(intersect(shape, ray, 1.001f * parameter), parameter);
  }
}

}  // namespace
}  // namespace donex::simulation
