// Clouds in other frames than their sensor's: lines of sight begin where the sensor was, or the cloud is refused.
#include <gtest/gtest.h>

#include "core/motion/surfaces.h"
#include "ros/cloud_placer.h"
#include "ros/pipeline_rig.h"

namespace donex {
namespace {

using test::PipelineRig;
using test::smallConfig;

constexpr double kSpeed = 5.0;  // [m/s]
constexpr double kStart = 100.0;
constexpr double kHeight = 1.7;  // of the sensor, as PipelineRig mounts it [m]

Config configWith(const std::string& sensor_frame, OdometrySource source = OdometrySource::kPose) {
  Config config = smallConfig(source);
  config.cloud.sensor_frame = sensor_frame;
  return config;
}

/// The usual ring around a sensor that has driven so far [m], as told in a frame that lies `height` lower.
std::vector<Eigen::Vector3f> movedRing(double way, double height = kHeight) {
  auto echoes = test::ring();
  for (Eigen::Vector3f& echo : echoes) echo += Eigen::Vector3d(way, 0.0, height).cast<float>();
  return echoes;
}

/// Scans in `frame`; with `is_registered` put together where the vehicle was.
void drive(PipelineRig& rig, const std::string& frame, bool is_registered, int scans = 8) {
  for (int i = 0; i < scans; ++i) {
    const double stamp = kStart + 0.1 * i, way = kSpeed * (stamp - kStart);
    rig.odometry(stamp, kSpeed);
    rig.pipeline.addCloud(test::plainCloud(movedRing(is_registered ? way : 0.0), stamp, frame), stamp);
    rig.run(stamp);
  }
  rig.pipeline.finish();
}

void expectTheUsualScans(const PipelineRig& rig) {
  PipelineRig usual(smallConfig());
  for (int i = 0; i < 8; ++i) {
    usual.odometry(kStart + 0.1 * i, kSpeed);
    usual.cloud(kStart + 0.1 * i);
    usual.run(kStart + 0.1 * i);
  }
  ASSERT_EQ(rig.labeled.size(), usual.labeled.size());
  for (std::size_t i = 0; i < usual.labeled.size(); ++i) {
    const test::Labeled &scan = rig.labeled[i], &expected = usual.labeled[i];
    EXPECT_TRUE(scan.base_from_sensor.isApprox(expected.base_from_sensor, 1e-9)) << i;
    EXPECT_TRUE(scan.odom_from_base.isApprox(expected.odom_from_base, 1e-9)) << i;
    ASSERT_EQ(scan.echoes.size(), expected.echoes.size());
    for (std::size_t k = 0; k < expected.echoes.size(); ++k) {
      EXPECT_LT((scan.echoes[k] - expected.echoes[k]).norm(), 1e-5F) << i << ", " << k;
    }
    EXPECT_EQ(scan.labels.dynamic, expected.labels.dynamic) << i;
  }
}

TEST(CloudPlacer, RegisteredCloudsAreSeenFromWhereTheSensorWas) {
  PipelineRig rig(configWith("lidar"));
  drive(rig, "odom", true);
  expectTheUsualScans(rig);
}

TEST(CloudPlacer, CloudsInTheVehiclesFrameAreSeenFromTheSensor) {
  PipelineRig rig(configWith("/lidar"));
  drive(rig, "base_link", false);
  expectTheUsualScans(rig);
}

TEST(CloudPlacer, AFrameThatTfPutsAnywhereIsAskedAtTheStamp) {
  PipelineRig rig(configWith("lidar"));
  for (int i = 0; i < 8; ++i) {
    const double stamp = kStart + 0.1 * i;
    rig.tf.setTransform(test::transformAt(stamp, "map", "base_link", kSpeed * (stamp - kStart)), "test", false);
  }
  drive(rig, "map", true);
  expectTheUsualScans(rig);
}

TEST(CloudPlacer, RegisteredCloudsWithoutSensorFrameAreRefused) {
  PipelineRig rig;
  rig.tf.setTransform(test::transformAt(0.0, "odom", "base_link", 0.0), "test", true);
  drive(rig, "odom", true);
  EXPECT_TRUE(rig.labeled.empty());
  ASSERT_EQ(rig.dropped(DropReason::kNoTransform), 8U);
  EXPECT_NE(rig.drops.at(0).find("set sensor_frame"), std::string::npos) << rig.drops[0];
}

TEST(CloudPlacer, AFrameInWhichTheVehicleMovesIsRefusedOnceThatShows) {
  PipelineRig rig;
  for (int i = 0; i < 8; ++i) {
    const double stamp = kStart + 0.1 * i;
    rig.tf.setTransform(test::transformAt(stamp, "map", "base_link", kSpeed * (stamp - kStart)), "test", false);
  }
  drive(rig, "map", true);
  EXPECT_LE(rig.labeled.size(), 3U) << "within a metre it may be a sensor that nods";
  ASSERT_GE(rig.drops.size(), 5U);
  EXPECT_NE(rig.drops.at(0).find("'map'"), std::string::npos) << rig.drops[0];
}

TEST(CloudPlacer, ASensorFrameThatTfDoesNotKnowIsSaid) {
  PipelineRig rig(configWith("lidar"));
  drive(rig, "merged", false);
  EXPECT_TRUE(rig.labeled.empty());
  EXPECT_NE(rig.drops.at(0).find("sensor_frame"), std::string::npos) << rig.drops[0];
}

TEST(CloudPlacer, CloudsThatStandStillTellNoMotion) {
  PipelineRig rig(configWith("", OdometrySource::kLidar), false);
  for (int i = 0; i < 3; ++i) {
    const double stamp = kStart + 0.1 * i;
    const auto echoes = testing::seenFrom(Eigen::Isometry3d::Identity(), testing::courtyard());
    rig.pipeline.addCloud(test::plainCloud(echoes, stamp, "odom"), stamp);
    rig.run(stamp);
  }
  rig.pipeline.finish();
  EXPECT_TRUE(rig.labeled.empty());
  EXPECT_NE(rig.drops.at(0).find("stands still"), std::string::npos) << rig.drops[0];
}

}  // namespace
}  // namespace donex
