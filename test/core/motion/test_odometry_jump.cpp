#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/motion/motion_samples.h"
#include "core/motion/odometry_jump.h"

namespace donex {
namespace {

using testing::SteadyDrive;

Eigen::Isometry3d at(double x, double y = 0.0) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(x, y, 0.0);
  return pose;
}

TEST(OdometryJump, IsNoFastDriveAndNoBend) {
  const SteadyDrive drive{{{30.0, 0.0, 0.0}, {0.0, 0.0, 0.6}}};
  OdometryJump jump;
  for (int i = 0; i < 50; ++i) EXPECT_EQ(jump.follow(0.1 * i, drive.poseAt(0.1 * i)), 0.0) << i;
}

TEST(OdometryJump, IsNoEmergencyBraking) {
  OdometryJump jump;
  double x = 0.0, speed = 15.0;
  for (int i = 0; i < 30; ++i) {
    EXPECT_EQ(jump.follow(0.2 * i, at(x)), 0.0) << i;
    x += 0.2 * speed;
    speed = std::max(0.0, speed - 0.2 * 10.0);
  }
}

TEST(OdometryJump, IsNoNoiseOfThreeCentimetres) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.03);
  OdometryJump jump;
  for (int i = 0; i < 2000; ++i) {
    const double x = 0.8 * i + noise(random), y = noise(random);
    EXPECT_EQ(jump.follow(0.1 * i, at(x, y)), 0.0) << i;
  }
}

TEST(OdometryJump, IsToldOnceWithItsSize) {
  OdometryJump jump;
  for (int i = 0; i < 20; ++i) {
    const double told = jump.follow(0.1 * i, at(1.0 * i, i < 10 ? 0.0 : 0.5));
    EXPECT_NEAR(told, i == 10 ? 0.5 : 0.0, 1e-9) << i;
  }
}

TEST(OdometryJump, OfAnOdometryThatFreezesIsToldOnce) {
  OdometryJump jump;
  int told = 0;
  for (int i = 0; i < 20; ++i) told += jump.follow(0.1 * i, at(std::min(1.0 * i, 10.0))) > 0.0 ? 1 : 0;
  EXPECT_EQ(told, 1);
}

TEST(OdometryJump, IsNotTakenFromAGapOrATimeThatRanBack) {
  OdometryJump jump;
  jump.follow(0.0, at(0.0));
  jump.follow(0.1, at(1.0));
  EXPECT_EQ(jump.follow(5.0, at(1.2)), 0.0);
  EXPECT_EQ(jump.follow(1.0, at(40.0)), 0.0);
  EXPECT_EQ(jump.follow(1.1, at(41.0)), 0.0);
}

}  // namespace
}  // namespace donex
