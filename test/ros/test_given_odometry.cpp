// Planar odometry through the pipeline: the clouds tell height, roll and pitch, and what is published stays where the
// odometry has it.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/motion/motion_samples.h"
#include "core/motion/surfaces.h"
#include "ros/given_odometry.h"
#include "ros/pipeline_rig.h"

namespace donex {
namespace {

using test::PipelineRig;
using test::smallConfig;
using testing::distanceBetween;

constexpr double kSpeed = 4.0;  // [m/s]
constexpr double kStart = 100.0;

Eigen::Isometry3d planarPose(double stamp) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation().x() = kSpeed * (stamp - kStart);
  return pose;
}

/// After a metre the ground rises by 3 %, and the vehicle pitches with it.
Eigen::Isometry3d truePose(double stamp) {
  Eigen::Isometry3d pose = planarPose(stamp);
  const double slope = 0.03, way = std::max(0.0, pose.translation().x() - 1.0);
  pose.translation().z() = slope * way;
  if (way > 0.0) pose.linear() = Eigen::AngleAxisd(-std::atan(slope), Eigen::Vector3d::UnitY()).toRotationMatrix();
  return pose;
}

double stampOf(int scan) { return kStart + 0.1 * scan; }

ScanMotion motionAt(double stamp) {
  ScanMotion motion;
  motion.odom_from_base = planarPose(stamp);
  return motion;
}

Scan scanAt(double stamp) {
  Scan scan;
  scan.stamp = stamp;
  scan.odom_from_base = planarPose(stamp);
  scan.echoes = testing::seenFrom(truePose(stamp), testing::courtyard());
  return scan;
}

/// Scans whose height, roll and pitch are found, of twelve.
int completedOf(GivenOdometry& odometry, ScanMotion motion, OdometrySource source) {
  int completed = 0;
  for (int i = 0; i < 12; ++i) {
    Scan scan = scanAt(stampOf(i));
    completed += odometry.complete(scan, motion, source) ? 1 : 0;
    EXPECT_TRUE(completed > 0 || odometry.odomFromWorld().isApprox(Eigen::Isometry3d::Identity(), 0.0)) << i;
  }
  return completed;
}

TEST(GivenOdometry, GetsHeightRollAndPitchFromTheClouds) {
  GivenOdometry odometry(smallConfig());
  for (int i = 0; i < 12; ++i) {
    const double stamp = stampOf(i);
    Scan scan = scanAt(stamp);
    EXPECT_EQ(odometry.complete(scan, motionAt(stamp), OdometrySource::kPose), i > 1) << i;
    EXPECT_LT(distanceBetween(scan.odom_from_base, truePose(stamp)), 2e-3) << i;
    EXPECT_TRUE((odometry.odomFromWorld() * scan.odom_from_base).isApprox(planarPose(stamp), 1e-12)) << i;
    odometry.learn(std::vector<std::uint8_t>(scan.echoes.size(), 0));
  }
}

TEST(GivenOdometry, IsLeftAloneWhereNothingIsLacking) {
  const auto completed = [](const Config& config, const ScanMotion& motion, OdometrySource source) {
    GivenOdometry odometry(config);
    return completedOf(odometry, motion, source);
  };
  const Config config = smallConfig();
  EXPECT_EQ(completed(config, {}, OdometrySource::kTf), 10);
  EXPECT_EQ(completed(config, {}, OdometrySource::kNone), 0) << "the sensor stands";
  ScanMotion tracked;
  tracked.tracked.emplace();
  EXPECT_EQ(completed(config, tracked, OdometrySource::kLidar), 0) << "the clouds tell all of it";
  ScanMotion registered;
  registered.sensor_from_cloud.emplace(Eigen::Isometry3d::Identity());
  EXPECT_EQ(completed(config, registered, OdometrySource::kPose), 0) << "somebody has registered the clouds";
  Config off = config;
  off.motion.odometry_refine = false;
  EXPECT_EQ(completed(off, {}, OdometrySource::kPose), 0);
}

TEST(GivenOdometry, GivesAWholeDriveTheSamePosesEachTime) {
  Config config = smallConfig();
  config.method = Method::kPeopleremover;
  const auto last_pose = [&](std::uint8_t label) {
    GivenOdometry odometry(config);
    Scan scan;
    for (int i = 0; i < 12; ++i) {
      scan = scanAt(stampOf(i));
      odometry.complete(scan, motionAt(scan.stamp), OdometrySource::kPose);
      odometry.learn(std::vector<std::uint8_t>(scan.echoes.size(), label));
    }
    return scan.odom_from_base;
  };
  EXPECT_TRUE(last_pose(0).isApprox(last_pose(1), 0.0)) << "labels differ from one showing to the next";
  EXPECT_GT(last_pose(0).translation().z(), 0.05);
}

TEST(GivenOdometry, IsCompletedInThePipelineAndSaidOnce) {
  PipelineRig rig;
  const Eigen::Isometry3d base_from_sensor(Eigen::Translation3d(0.0, 0.0, 1.7));  // the rig's
  for (int i = 0; i < 12; ++i) {
    const double stamp = stampOf(i);
    rig.odometry(stamp, kSpeed);
    const auto echoes = testing::seenFrom(truePose(stamp) * base_from_sensor, testing::courtyard());
    rig.pipeline.addCloud(test::plainCloud(echoes, stamp), stamp);
    rig.run(stamp);
  }
  ASSERT_EQ(rig.labeled.size(), 12U);
  EXPECT_EQ(rig.pipeline.counts().completed, 10U);
  ASSERT_EQ(rig.completed.size(), 1U);
  EXPECT_NE(rig.completed[0].find("never leaves its plane"), std::string::npos) << rig.completed[0];
  const test::Labeled& last = rig.labeled.back();
  EXPECT_LT(distanceBetween(last.odom_from_base, truePose(last.stamp)), 2e-3);
  EXPECT_TRUE((last.odom_from_world * last.odom_from_base).isApprox(planarPose(last.stamp), 1e-12));
  rig.pipeline.reset();
  rig.odometry(stampOf(12), kSpeed);
  rig.cloud(stampOf(12));
  rig.run(stampOf(12));
  EXPECT_EQ(rig.labeled.back().odom_from_base.translation().z(), 0.0) << "an empty grid has no height of its own";
}

}  // namespace
}  // namespace donex
