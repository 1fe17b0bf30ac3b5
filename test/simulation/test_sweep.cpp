// What a turn of the sensor says, against the scene it was measured in.
#include <cmath>

#include <gtest/gtest.h>

#include "simulation/scene.h"
#include "simulation/simulator.h"

namespace donex::simulation {
namespace {

constexpr double kNoise = 0.015;  // [m]

/// The scene a simulator builds for itself.
struct Known {
  Known(const std::string& name, const SimulatorOptions& options)
      : scene(makeScene(name, static_cast<std::uint64_t>(options.seed))), simulator(name, options) {
    scene_from_odom = poseOf(scene.ego, scene.ground, 0.0) * simulator.odomFromBase(options.start_stamp).inverse();
  }
  Eigen::Vector3d inScene(const SimulatedEcho& echo, double stamp) const {
    const Eigen::Isometry3d sensor = simulator.odomFromBase(stamp) * simulator.baseFromSensor();
    return scene_from_odom * (sensor * echo.position.cast<double>());
  }

  Scene scene;
  Simulator simulator;
  Eigen::Isometry3d scene_from_odom;
};

/// From the surface of the nearest upright wall [m].
double distanceToWalls(const Scene& scene, const Eigen::Vector3d& point) {
  double nearest = INFINITY;
  for (const Fixture& fixture : scene.fixtures) {
    if (fixture.label != 50) continue;
    const Eigen::Vector3d local = fixture.shape.axes.cast<double>().transpose() * (point - fixture.center);
    const Eigen::Vector3d beyond = local.cwiseAbs() - fixture.shape.half.cast<double>();
    const double outside = beyond.cwiseMax(0.0).norm();
    const double inside = std::min(0.0, beyond.maxCoeff());
    nearest = std::min(nearest, std::abs(outside + inside));
  }
  return nearest;
}

struct Off {
  double undone = 0.0, as_measured = 0.0;
  int echoes = 0;
};

/// How far from the walls the echoes of walls lie, by their own times and as if all were measured at the stamp.
Off wallsOff(const std::string& name, bool distortion) {
  SimulatorOptions options;
  options.distortion = distortion;
  options.range_noise = 0.0;
  options.seed = 3;
  Known known(name, options);
  SimulatedScan scan;
  Off off;
  for (int k = 0; k < 6; ++k) {
    known.simulator.next(scan);
    for (std::size_t i = 0; i < scan.echoes.size(); i += 37) {
      if (scan.labels[i] != 50) continue;
      const double time = static_cast<double>(scan.echoes[i].time);
      off.undone += distanceToWalls(known.scene, known.inScene(scan.echoes[i], scan.stamp + time));
      off.as_measured += distanceToWalls(known.scene, known.inScene(scan.echoes[i], scan.stamp));
      ++off.echoes;
    }
  }
  off.undone /= off.echoes;
  off.as_measured /= off.echoes;
  return off;
}

TEST(Sweep, WithoutDistortionWallsAreWhereTheyAre) {
  const Off off = wallsOff("street", false);
  EXPECT_GT(off.echoes, 1000);
  EXPECT_LT(off.undone, 1e-3);
  EXPECT_EQ(off.undone, off.as_measured);
}

TEST(Sweep, DistortionIsUndoneByTheTrueMotion) {
  for (const char* name : {"street", "turning"}) {
    const Off off = wallsOff(name, true);
    EXPECT_GT(off.echoes, 500) << name;
    EXPECT_LT(off.undone, 2e-3) << name;
    EXPECT_GT(off.as_measured, 20.0 * off.undone) << name;
  }
}

TEST(Sweep, RoadEchoesLieOnTheRoad) {
  for (const char* name : {"slope", "bend"}) {
    SimulatorOptions options;
    options.beams = 32;
    Known known(name, options);
    SimulatedScan scan;
    int echoes = 0;
    for (int k = 0; k < 10; ++k) known.simulator.next(scan);
    for (std::size_t i = 0; i < scan.echoes.size(); i += 11) {
      if (scan.labels[i] != 40 || scan.echoes[i].position.norm() > 40.0f) continue;
      const Eigen::Vector3d point = known.inScene(scan.echoes[i], scan.stamp);
      EXPECT_NEAR(point.z(), known.scene.ground.height(point.head<2>()), 0.13) << name;  // a kerb's height at most
      ++echoes;
    }
    EXPECT_GT(echoes, 500) << name;
  }
}

void expectMovingEchoesInBoxes(const std::string& name, bool distortion) {
  SimulatorOptions options;
  options.distortion = distortion;
  options.seed = 2;
  Simulator simulator(name, options);
  SimulatedScan scan;
  int moving = 0;
  for (int k = 0; k < 8; ++k) {
    simulator.next(scan);
    for (std::size_t i = 0; i < scan.echoes.size(); ++i) {
      const std::uint32_t instance = scan.labels[i] >> 16;
      if (instance == 0 || i % 61 != 0) continue;
      const double time = scan.stamp + static_cast<double>(scan.echoes[i].time);
      const Eigen::Isometry3d odom_from_sensor = simulator.odomFromBase(time) * simulator.baseFromSensor();
      const Eigen::Vector3d point = odom_from_sensor * scan.echoes[i].position.cast<double>();
      const MoverTruth truth = simulator.mover(instance - 1, time);
      const Eigen::Vector3d local = truth.odom_from_box.inverse() * point;
      EXPECT_LT((local.cwiseAbs() - 0.5 * truth.size).maxCoeff(), 5.0 * kNoise) << name << ' ' << truth.label;
      EXPECT_EQ(scan.labels[i], simulator.mover(instance - 1, scan.stamp).label);
      ++moving;
    }
  }
  EXPECT_GT(moving, 150) << name;
}

TEST(Sweep, MovingEchoesLieInsideTheirThings) {
  for (const char* name : {"intersection", "street", "motorway", "crowd"}) {
    for (const bool distortion : {false, true}) expectMovingEchoesInBoxes(name, distortion);
  }
}

TEST(Sweep, RangeNoiseHasItsDeviation) {
  SimulatorOptions options;
  options.beams = 32;
  options.range_noise = 0.05;
  options.dropout = 0.0;
  options.odometry = OdometryOptions::exact();
  Simulator noisy("empty_room", options);
  options.range_noise = 0.0;
  Simulator exact("empty_room", options);
  SimulatedScan a, b;
  double sum = 0.0;
  double squares = 0.0;
  int count = 0;
  for (int k = 0; k < 3; ++k) {
    noisy.next(a);
    exact.next(b);
    ASSERT_EQ(a.echoes.size(), b.echoes.size());
    for (std::size_t i = 0; i < a.echoes.size(); ++i) {
      const double off = static_cast<double>(a.echoes[i].position.norm() - b.echoes[i].position.norm());
      sum += off;
      squares += off * off;
      ++count;
    }
  }
  EXPECT_NEAR(std::sqrt(squares / count), 0.05, 0.001);
  EXPECT_NEAR(sum / count, 0.0, 0.001);
}

TEST(Sweep, DropoutLosesItsFraction) {
  SimulatorOptions options;
  options.dropout = 0.0;
  SimulatedScan all, some;
  Simulator("empty_room", options).next(all);
  options.dropout = 0.2;
  Simulator("empty_room", options).next(some);
  EXPECT_NEAR(static_cast<double>(some.echoes.size()) / static_cast<double>(all.echoes.size()), 0.8, 0.01);
}

}  // namespace
}  // namespace donex::simulation
