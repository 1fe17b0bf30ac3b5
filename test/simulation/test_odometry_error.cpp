#include <cmath>

#include <gtest/gtest.h>

#include "simulation/odometry_error.h"

namespace donex::simulation {
namespace {

/// Round a circle of radius 50 m at 10 m/s.
Eigen::Isometry3d poseAt(double time) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() << 50.0 * std::sin(0.2 * time), 50.0 * (1.0 - std::cos(0.2 * time)), 0.0;
  pose.rotate(Eigen::AngleAxisd(0.2 * time, Eigen::Vector3d::UnitZ()));
  return pose;
}

Twist trueTwist() { return {{10.0, 0.0, 0.0}, {0.0, 0.0, 0.2}}; }

TEST(OdometryError, ExactOptionsReportTheTruth) {
  OdometryError error(OdometryOptions::exact(), 1);
  for (int i = 0; i < 500; ++i) {
    const OdometrySample sample = error.report(0.02 * i, poseAt(0.02 * i), trueTwist());
    EXPECT_EQ(sample.stamp, 0.02 * i);
    EXPECT_TRUE(sample.odom_from_base.isApprox(poseAt(0.02 * i), 1e-9));
    EXPECT_EQ(sample.twist.linear, trueTwist().linear);
  }
}

TEST(OdometryError, WhiteNoiseHasItsDeviation) {
  OdometryOptions options = OdometryOptions::exact();
  options.position_noise = 0.02;
  options.rotation_noise = 0.003;
  options.linear_noise = 0.1;
  OdometryError error(options, 2);
  constexpr int kSamples = 4000;
  double position = 0.0;
  double rotation = 0.0;
  double linear = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const OdometrySample sample = error.report(0.02 * i, poseAt(0.02 * i), trueTwist());
    const Eigen::Isometry3d off = poseAt(0.02 * i).inverse() * sample.odom_from_base;
    position += off.translation().squaredNorm();
    rotation += std::pow(Eigen::AngleAxisd(off.linear()).angle(), 2);
    linear += (sample.twist.linear - trueTwist().linear).squaredNorm();
  }
  EXPECT_NEAR(std::sqrt(position / (3.0 * kSamples)), 0.02, 0.001);
  EXPECT_NEAR(std::sqrt(rotation / (3.0 * kSamples)), 0.003, 0.00015);
  EXPECT_NEAR(std::sqrt(linear / (3.0 * kSamples)), 0.1, 0.005);
}

TEST(OdometryError, DriftGrowsWithTheWay) {
  OdometryOptions options = OdometryOptions::exact();
  options.drift = 0.01;
  options.yaw_drift = 0.0005;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    OdometryError error(options, seed);
    double way = 0.0;
    double turned = 0.0;
    Eigen::Isometry3d last = poseAt(0.0);
    for (int i = 0; i <= 500; ++i) {
      const Eigen::Isometry3d reported = error.report(0.02 * i, poseAt(0.02 * i), trueTwist()).odom_from_base;
      way += (reported.translation() - last.translation()).norm();
      const Eigen::Matrix3d turn = last.linear().transpose() * reported.linear();
      turned += std::atan2(turn(1, 0), turn(0, 0));
      last = reported;
    }
    EXPECT_NEAR(std::abs(way / 100.0 - 1.0), 0.01, 0.001);
    EXPECT_NEAR(std::abs(turned - 2.0), 0.0005 * 100.0, 0.002);
  }
}

TEST(OdometryError, OffsetMovesTheStampsOnly) {
  OdometryOptions options = OdometryOptions::exact();
  options.stamp_offset = 0.02;
  OdometryError error(options, 3);
  error.report(0.0, poseAt(0.0), trueTwist());
  const OdometrySample sample = error.report(1.0, poseAt(1.0), trueTwist());
  EXPECT_NEAR(sample.stamp, 1.02, 1e-12);
  EXPECT_TRUE(sample.odom_from_base.isApprox(poseAt(1.0), 1e-9));
}

}  // namespace
}  // namespace donex::simulation
