#include <cmath>

#include <gtest/gtest.h>

#include "simulation/ground.h"
#include "simulation/ground_window.h"
#include "simulation/random.h"
#include "simulation/sensor_model.h"
#include "simulation/shape.h"

namespace donex::simulation {
namespace {

Ground makeGround(std::uint64_t seed) {
  Ground ground({}, seed);
  ground.add({Path({-200.0, 3.0}, 0.1).line(150.0).arc(80.0, 0.9).line(200.0), 5.0});
  ground.add(Slope{{20.0, 0.0}, 0.3, 60.0, 0.08});
  return ground;
}

TEST(Ground, HasAKerbAndThePavementBehindIt) {
  GroundStyle style;
  style.waves = 0.0;
  Ground ground(style, 1);
  ground.add({Path({-50.0, 0.0}, 0.0).line(100.0), 4.0});
  EXPECT_EQ(ground.at({0.0, 0.0}).label, 40U);
  EXPECT_EQ(ground.at({0.0, 5.0}).label, 48U);
  EXPECT_EQ(ground.at({0.0, 9.0}).label, 72U);
  EXPECT_NEAR(ground.height({0.0, 4.2}) - ground.height({0.0, 3.99}), style.kerb_height, 0.01);
  EXPECT_GT(ground.height({0.0, 0.0}), ground.height({0.0, 3.9}));
  EXPECT_NEAR(ground.beyondEdge({10.0, -6.5}), 2.5, 1e-9);
}

TEST(Ground, RisesByItsGradeOverASlope) {
  GroundStyle style;
  style.waves = style.roughness = 0.0;
  Ground ground(style, 1);
  ground.add(Slope{{0.0, 0.0}, 0.0, 100.0, 0.1});
  EXPECT_NEAR(ground.height({300.0, 5.0}) - ground.height({-200.0, 5.0}), 10.0, 0.15);
  EXPECT_NEAR(ground.height({60.0, 0.0}) - ground.height({50.0, 0.0}), 1.0, 0.05);
}

TEST(GroundWindow, HoldsTheGroundAtItsSamples) {
  const Ground ground = makeGround(2);
  GroundWindow window(ground);
  window.moveTo({13.0, -7.0});
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    const double x = GroundWindow::kCell * (random.below(800) - 400);
    const double y = GroundWindow::kCell * (random.below(800) - 400);
    EXPECT_NEAR(window.height(x, y), ground.height({x, y}), 2e-3);
    EXPECT_EQ(window.label(x, y), ground.at({x, y}).label);
  }
}

TEST(GroundWindow, IsTheSameAfterManyMovesAsBuiltAnew) {
  const Ground ground = makeGround(4);
  GroundWindow moved(ground);
  Random random(5);
  Eigen::Vector2d center(-40.0, 20.0);
  for (int i = 0; i < 60; ++i) {
    center += Eigen::Vector2d(random.uniform(-6.0, 9.0), random.uniform(-8.0, 6.0));
    if (i == 30) center += Eigen::Vector2d(500.0, 0.0);
    moved.moveTo(center);
  }
  GroundWindow fresh(ground);
  fresh.moveTo(center);
  for (int i = 0; i < 3000; ++i) {
    const double x = center.x() + random.uniform(-95.0, 95.0);
    const double y = center.y() + random.uniform(-95.0, 95.0);
    ASSERT_EQ(moved.height(x, y), fresh.height(x, y)) << x << ' ' << y;
    ASSERT_EQ(moved.label(x, y), fresh.label(x, y));
  }
}

/// The ray against the ground, in small steps and without a neighbour's help.
struct Marched {
  double enter = INFINITY;
  double deepest = 0.0;  // below the ground before `until` [m]
};

double clearance(const GroundWindow& window, const RayFan& fan, float slope, double parameter) {
  const Eigen::Vector3d at = fan.origin + parameter * (fan.forward + static_cast<double>(slope) * fan.up);
  return at.z() - static_cast<double>(window.height(at.x(), at.y()));
}

Marched march(const GroundWindow& window, const RayFan& fan, float slope, double until) {
  constexpr double kStep = 0.02;
  Marched result;
  for (double r = 0.3; r < GroundWindow::kReach; r += kStep) {
    const double above = clearance(window, fan, slope, r);
    if (above < 0.0) result.enter = std::min(result.enter, r);
    if (r < until) result.deepest = std::max(result.deepest, -above);
    if (std::isfinite(result.enter) && r >= until) break;
  }
  return result;
}

TEST(GroundWindow, MeetsEveryRayWhereMarchingDoes) {
  const Ground ground = makeGround(6);
  const SensorModel model = makeSensorModel(64);
  GroundWindow window(ground);
  Random random(7);
  constexpr double kTouch = 0.04;  // [m]
  int met = 0;
  double total_off = 0.0;
  for (int i = 0; i < 25; ++i) {
    const Eigen::Vector2d place(random.uniform(-60.0, 60.0), random.uniform(-30.0, 30.0));
    window.moveTo(place);
    const double yaw = random.uniform(-3.1, 3.1);
    const double roll = random.uniform(-0.03, 0.03);
    const double pitch = random.uniform(-0.03, 0.03);
    const Eigen::Matrix3d axes =
        (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
            .toRotationMatrix();
    const RayFan fan{{place.x(), place.y(), ground.height(place) + 1.75}, axes.col(0), axes.col(2), model.slopes};
    std::vector<float> parameters;
    window.meet(fan, parameters);
    for (std::size_t beam = 0; beam < model.slopes.size(); ++beam) {
      const auto parameter = static_cast<double>(parameters[beam]);
      const Marched marched = march(window, fan, model.slopes[beam], parameter);
      if (std::isinf(marched.enter)) {
        EXPECT_TRUE(std::isinf(parameter));
        continue;
      }
      if (std::isinf(parameter)) {
        EXPECT_LT(marched.deepest, kTouch);
        continue;
      }
      ++met;
      // On the ground, and nothing on the way but what the ray barely touches.
      const double off = std::abs(clearance(window, fan, model.slopes[beam], parameter));
      EXPECT_LT(off, kTouch) << "beam " << beam;
      total_off += off;
      EXPECT_LT(marched.deepest, kTouch) << "beam " << beam;
    }
  }
  EXPECT_GT(met, 1000);
  EXPECT_LT(total_off / met, 0.001);
}

}  // namespace
}  // namespace donex::simulation
