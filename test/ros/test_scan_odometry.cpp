// Ego motion from the clouds through the pipeline: no odometry, no tf.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/motion/surfaces.h"
#include "ros/odometry_publisher.h"
#include "ros/pipeline_rig.h"

namespace donex {
namespace {

using test::PipelineRig;
using test::smallConfig;

constexpr double kSpeed = 5.0;  // [m/s]
constexpr double kStart = 100.0;

/// What a sensor sees that drives along x through a courtyard.
sensor_msgs::PointCloud2ConstPtr cloudAt(double stamp) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation().x() = kSpeed * (stamp - kStart);
  return test::plainCloud(testing::seenFrom(pose, testing::courtyard()), stamp);
}

void drive(PipelineRig& rig, int scans) {
  for (int i = 0; i < scans; ++i) {
    const double stamp = kStart + 0.1 * i;
    rig.pipeline.addCloud(cloudAt(stamp), stamp);
    rig.run(stamp);
  }
  rig.pipeline.finish();
}

TEST(ScanOdometry, NeedsNeitherOdometryNorTf) {
  PipelineRig rig(smallConfig(OdometrySource::kLidar), false);
  drive(rig, 12);
  ASSERT_EQ(rig.labeled.size(), 12U);
  EXPECT_TRUE(rig.forgotten.empty());
  for (const test::Labeled& scan : rig.labeled) {
    EXPECT_NEAR(scan.odom_from_base.translation().x(), kSpeed * (scan.stamp - kStart), 1e-3);
    EXPECT_TRUE(scan.base_from_sensor.isApprox(Eigen::Isometry3d::Identity())) << "the sensor is the vehicle";
  }
}

TEST(ScanOdometry, TakesTheMountingFromTfWhereItIsThere) {
  PipelineRig rig(smallConfig(OdometrySource::kLidar), true);
  drive(rig, 6);
  ASSERT_EQ(rig.labeled.size(), 6U);
  EXPECT_NEAR(rig.labeled.back().base_from_sensor.translation().z(), 1.7, 1e-9);
  EXPECT_NEAR(rig.labeled.back().odom_from_base.translation().z(), 0.0, 1e-3);
}

TEST(ScanOdometry, TwoSensorsOfOneVehicleShareItsMotion) {
  const auto world = testing::courtyard();
  Eigen::Isometry3d roof = Eigen::Isometry3d::Identity(), bumper = Eigen::Isometry3d::Identity();
  roof.translation().z() = 0.5;
  bumper.translate(Eigen::Vector3d(2.0, -0.4, -0.6)).rotate(Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitZ()));
  ScanOdometry odometry;
  for (int i = 0; i < 20; ++i) {
    const Eigen::Isometry3d& mounting = i % 2 == 0 ? roof : bumper;
    Eigen::Isometry3d odom_from_base = Eigen::Isometry3d::Identity();
    odom_from_base.translation().x() = kSpeed * 0.05 * i;
    const auto echoes = testing::seenFrom(odom_from_base * mounting, world);
    const TrackedScan& tracked = odometry.locate(kStart + 0.05 * i, echoes, {}, mounting);
    EXPECT_EQ(tracked.is_new_track, i == 0) << i;
    EXPECT_TRUE(odometry.odomFromBase().isApprox(odom_from_base, 1e-3)) << i;
  }
}

TEST(ScanOdometry, AutoTakesTheCloudsHoweverManyOfThemWait) {
  const Config config = smallConfig(OdometrySource::kAuto);
  const double step = 0.5 * config.motion.odometry_timeout / config.node.queue_size;
  PipelineRig rig(config, false);
  for (int i = 0; i < 4 * config.node.queue_size; ++i) {
    const double stamp = kStart + step * i;
    rig.pipeline.addCloud(cloudAt(stamp), stamp);
    rig.run(stamp);
  }
  EXPECT_GT(rig.labeled.size(), static_cast<std::size_t>(config.node.queue_size));
}

/// Echoes in a sector of `sectors`, from behind on.
std::vector<Eigen::Vector3f> sectorOf(const std::vector<Eigen::Vector3f>& echoes, int sector, int sectors) {
  std::vector<Eigen::Vector3f> kept;
  for (const Eigen::Vector3f& echo : echoes) {
    const double turned = 0.5 + static_cast<double>(std::atan2(echo.y(), echo.x())) / (2.0 * M_PI);
    if (static_cast<int>(turned * sectors) == sector) kept.push_back(echo);
  }
  return kept;
}

TEST(ScanOdometry, PartsOfATurnAreRegisteredTogether) {
  constexpr int kParts = 4, kTurns = 15;
  const auto world = testing::courtyard();
  ScanOdometry odometry;
  for (int i = 0; i < kTurns * kParts; ++i) {
    const double time = 0.1 / kParts * i;
    Eigen::Isometry3d odom_from_base = Eigen::Isometry3d::Identity();
    odom_from_base.translation().x() = 3.0 * std::max(0.0, time - 0.3);
    const auto echoes = sectorOf(testing::seenFrom(odom_from_base, world), i % kParts, kParts);
    const TrackedScan& tracked = odometry.locate(kStart + time, echoes, {}, Eigen::Isometry3d::Identity());
    EXPECT_NE(tracked.status, TrackingStatus::kLost) << i;
    EXPECT_FALSE(tracked.is_new_track && i > 0) << i;
    odometry.learn(std::vector<std::uint8_t>(echoes.size(), 0));
    const double error = (odometry.odomFromBase().translation() - odom_from_base.translation()).norm();
    EXPECT_LT(error, time < 0.8 ? 0.5 : 0.02) << "part " << i;
  }
}

TEST(ScanOdometry, ASecondSensorThatTfDoesNotPlaceIsDropped) {
  PipelineRig rig(smallConfig(OdometrySource::kLidar), false);
  drive(rig, 5);
  auto cloud = boost::make_shared<sensor_msgs::PointCloud2>(*cloudAt(kStart + 0.5));
  cloud->header.frame_id = "another_sensor";
  rig.pipeline.addCloud(cloud, kStart + 0.5);
  rig.pipeline.finish();
  EXPECT_EQ(rig.labeled.size(), 5U);
  EXPECT_EQ(rig.dropped(DropReason::kNoTransform), 1U);
}

TEST(ScanOdometry, ACloudThatDoesNotFitIsDroppedForThatReason) {
  PipelineRig rig(smallConfig(OdometrySource::kLidar), false);
  drive(rig, 5);
  rig.pipeline.addCloud(test::plainCloud({{1.0F, 2.0F, 3.0F}}, kStart + 0.5), kStart + 0.5);
  rig.pipeline.finish();
  EXPECT_EQ(rig.dropped(DropReason::kLost), 1U);
  rig.pipeline.addCloud(cloudAt(kStart + 0.6), kStart + 0.6);
  rig.pipeline.finish();
  EXPECT_EQ(rig.labeled.size(), 6U) << "and the next one is found again";
}

TEST(ScanOdometry, AutoTakesOdometryWhereThereIsSome) {
  PipelineRig rig(smallConfig(OdometrySource::kAuto));
  for (int i = 0; i < 20; ++i) rig.odometry(kStart + 0.05 * i, kSpeed);
  drive(rig, 6);
  EXPECT_EQ(rig.labeled.size(), 6U);
  EXPECT_EQ(rig.pipeline.motion().source(), OdometrySource::kPose);
  EXPECT_NE(rig.pipeline.motion().choice().find("odometry messages"), std::string::npos);
}

TEST(ScanOdometry, AutoTakesTfWhereThereIsNoOdometry) {
  PipelineRig rig(smallConfig(OdometrySource::kAuto));
  for (int i = 0; i < 40; ++i) {
    const double stamp = kStart + 0.05 * i;
    rig.tf.setTransform(test::transformAt(stamp, "odom", "base_link", kSpeed * (stamp - kStart), 0.0), "test", false);
  }
  drive(rig, 10);
  EXPECT_EQ(rig.pipeline.motion().source(), OdometrySource::kTf);
  EXPECT_EQ(rig.labeled.size(), 10U);
}

TEST(ScanOdometry, AutoTakesTheCloudsWhereThereIsNothingElse) {
  PipelineRig rig(smallConfig(OdometrySource::kAuto), false);
  drive(rig, 12);
  EXPECT_EQ(rig.pipeline.motion().source(), OdometrySource::kLidar);
  EXPECT_EQ(rig.labeled.size(), 12U) << "those that waited for odometry are labelled as well";
}

TEST(ScanOdometry, TellsOthersPoseAndVelocity) {
  std::vector<nav_msgs::Odometry> told;
  PipelineEvents events;
  events.labeled = [&](const LabeledScan& scan) { told.push_back(toOdometry(scan)); };
  events.dropped = [](DropReason, const std::string&) {};
  events.refused = [](OdometryRefusal, const std::string&) {};
  events.forgotten = events.strange_times = [](const std::string&) {};
  tf2::BufferCore tf;
  Pipeline pipeline(smallConfig(OdometrySource::kLidar), tf, events);
  for (int i = 0; i < 6; ++i) pipeline.addCloud(cloudAt(kStart + 0.1 * i), kStart);
  pipeline.finish();
  ASSERT_EQ(told.size(), 6U);
  EXPECT_EQ(told.back().header.frame_id, "odom");
  EXPECT_EQ(told.back().child_frame_id, "lidar");
  EXPECT_NEAR(told.back().pose.pose.position.x, 2.5, 1e-3);
  EXPECT_NEAR(told.back().twist.twist.linear.x, kSpeed, 1e-2);
  EXPECT_NEAR(told.back().twist.twist.angular.z, 0.0, 1e-3);
}

}  // namespace
}  // namespace donex
