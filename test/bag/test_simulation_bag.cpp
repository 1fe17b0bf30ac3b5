// A simulated drive as a bag.
#include <algorithm>

#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_eigen/tf2_eigen.h>
#include <tf2_msgs/TFMessage.h>

#include "bag/bags.h"
#include "bag/simulation_bag.h"

namespace donex {
namespace {

simulation::SimulatorOptions shortDrive() {
  simulation::SimulatorOptions options;
  options.beams = 16;
  options.duration = 1.0;
  options.start_stamp = 5.0;
  return options;
}

TEST(SimulationBag, HoldsEveryScanAndTheOdometryBeforeIt) {
  const test::TemporaryDirectory directory;
  const auto file = directory.path() / "drive.bag";
  simulation::Simulator simulator("street", shortDrive());
  std::size_t heard = 0;
  const auto summary = writeSimulationBag(simulator, file, rosbag::compression::Uncompressed, [&] { ++heard; });
  EXPECT_EQ(heard, 10U);
  EXPECT_EQ(summary.clouds, 10U);

  simulation::Simulator again("street", shortDrive());
  simulation::SimulatedScan scan;
  const auto clouds = test::readTopic<sensor_msgs::PointCloud2>(file, "/points");
  ASSERT_EQ(clouds.size(), 10U);
  for (const auto& cloud : clouds) {
    ASSERT_TRUE(again.next(scan));
    EXPECT_EQ(cloud->width, scan.echoes.size());
    EXPECT_EQ(cloud->header.stamp, ros::Time(scan.stamp));
  }
  const auto odometry = test::readTopic<nav_msgs::Odometry>(file, "/odom");
  EXPECT_EQ(odometry.size(), summary.odometry);
  EXPECT_LE(odometry.front()->header.stamp, ros::Time(5.0));
  EXPECT_GE(odometry.back()->header.stamp, clouds.back()->header.stamp);
}

TEST(SimulationBag, LateStampsOfSlowOdometryAreNotBeforeTime) {
  const test::TemporaryDirectory directory;
  const auto file = directory.path() / "drive.bag";
  EXPECT_EQ(leastStart({}), 2.0);
  for (const double offset : {-1.0, 1.0}) {
    simulation::SimulatorOptions options = shortDrive();
    options.duration = 0.2;
    options.odometry.rate = 1.0;
    options.odometry.stamp_offset = offset;
    options.start_stamp = leastStart(options.odometry);
    simulation::Simulator simulator("street", options);
    writeSimulationBag(simulator, file, rosbag::compression::Uncompressed, [] {});
    const auto odometry = test::readTopic<nav_msgs::Odometry>(file, "/odom");
    ASSERT_FALSE(odometry.empty());
    EXPECT_GE(odometry.front()->header.stamp, ros::Time(0.5)) << offset;
  }
}

TEST(SimulationBag, WhatCannotBeWrittenIsToldWithTheFile) {
  const test::TemporaryDirectory directory;
  const auto file = directory.path() / "drive.bag";
  simulation::SimulatorOptions options = shortDrive();
  options.start_stamp = 0.0;  // with this offset the odometry begins there, too: at no time of a bag
  options.odometry.stamp_offset = 0.1;
  simulation::Simulator simulator("street", options);
  try {
    writeSimulationBag(simulator, file, rosbag::compression::Uncompressed, [] {});
    FAIL() << "it was written";
  } catch (const DataError& error) {
    EXPECT_EQ(std::string(error.what()).rfind(file.string() + ": cannot be written (", 0), 0U) << error.what();
  }
}

TEST(SimulationBag, IsLabelledWholly) {
  const test::TemporaryDirectory directory;
  const auto file = directory.path() / "drive.bag";
  simulation::SimulatorOptions options = shortDrive();
  options.distortion = true;
  simulation::Simulator simulator("street", options);
  writeSimulationBag(simulator, file, rosbag::compression::LZ4, [] {});
  const LabelBagSummary summary = test::label(file, directory.path() / "labelled.bag");
  EXPECT_EQ(summary.counts.clouds_labeled, 10U);
  EXPECT_EQ(summary.counts.dropped.total(), 0U);
}

std::vector<sensor_msgs::PointCloud2ConstPtr> cloudsOf(const std::filesystem::path& file,
                                                       const simulation::SimulatorOptions& options) {
  simulation::Simulator simulator("street", options);
  const auto summary = writeSimulationBag(simulator, file, rosbag::compression::Uncompressed, [] {});
  auto clouds = test::readTopic<sensor_msgs::PointCloud2>(file, "/points");
  EXPECT_EQ(clouds.size(), simulator.size());
  EXPECT_EQ(clouds.size(), summary.clouds);
  return clouds;
}

LabelBagSummary expectLabelledWholly(const test::TemporaryDirectory& directory, const std::filesystem::path& file,
                                     std::size_t clouds) {
  const LabelBagSummary summary = test::label(file, directory.path() / "labelled.bag");
  EXPECT_EQ(summary.counts.clouds_labeled, clouds);
  EXPECT_EQ(summary.counts.dropped.total(), 0U);
  EXPECT_GT(summary.evaluation.total().moving(), 0U) << "scored by the truth they carry";
  return summary;
}

TEST(SimulationBag, HoldsEverySensorOfARigOnOneTopic) {
  for (const simulation::Rig& rig : simulation::rigs()) {
    const test::TemporaryDirectory directory;
    const auto file = directory.path() / "drive.bag";
    simulation::SimulatorOptions options = shortDrive();
    options.rig = rig.name;
    const auto clouds = cloudsOf(file, options);
    const std::size_t sensors = rig.mountings.size();
    ASSERT_EQ(clouds.size(), 10U * sensors) << rig.name;

    const auto statics = test::readTopic<tf2_msgs::TFMessage>(file, "/tf_static");
    ASSERT_EQ(statics.size(), 1U) << rig.name;
    ASSERT_EQ(statics[0]->transforms.size(), sensors) << rig.name;
    const simulation::Simulator simulator("street", options);
    for (std::size_t i = 0; i < sensors; ++i) {
      const geometry_msgs::TransformStamped& mounting = statics[0]->transforms[i];
      const std::string name = rig.mountings[i].sensor;
      EXPECT_EQ(mounting.header.frame_id, "base_link");
      EXPECT_EQ(mounting.child_frame_id, name.empty() ? "velodyne" : name);
      EXPECT_TRUE(tf2::transformToEigen(mounting).isApprox(simulator.baseFromSensor(i), 1e-9)) << name;
      const auto in_this_frame = [&](const auto& cloud) { return cloud->header.frame_id == mounting.child_frame_id; };
      EXPECT_EQ(std::count_if(clouds.begin(), clouds.end(), in_this_frame), 10) << name;
    }
    for (std::size_t i = 0; i < clouds.size(); ++i) {
      EXPECT_EQ(clouds[i]->header.stamp, clouds[i - i % sensors]->header.stamp) << "their clocks are synchronised";
    }
    expectLabelledWholly(directory, file, clouds.size());
  }
}

TEST(SimulationBag, HoldsThePartsOfARigEachAtItsTime) {
  const test::TemporaryDirectory directory;
  const auto file = directory.path() / "drive.bag";
  simulation::SimulatorOptions options = shortDrive();
  options.rig = "roof_bumper";
  options.parts = 4;
  options.distortion = true;
  const auto clouds = cloudsOf(file, options);
  ASSERT_EQ(clouds.size(), 80U);
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    EXPECT_NEAR(clouds[i]->header.stamp.toSec(), 5.0 + 0.025 * static_cast<double>(i / 2 + 1), 1e-6);
  }
  EXPECT_EQ(clouds[1]->width, 0U) << "the bumper's sensor begins behind itself";
  for (const std::string& remark : expectLabelledWholly(directory, file, clouds.size()).remarks) {
    EXPECT_EQ(remark.find("de-skewed by"), std::string::npos) << remark;
  }
}

TEST(SimulationBag, HoldsPartsWithoutDistortionOneAfterTheOther) {
  const test::TemporaryDirectory directory;
  const auto file = directory.path() / "drive.bag";
  simulation::SimulatorOptions options = shortDrive();
  options.parts = 10;
  const auto clouds = cloudsOf(file, options);
  ASSERT_EQ(clouds.size(), 100U);
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    EXPECT_NEAR(clouds[i]->header.stamp.toSec(), 5.1 + 0.1 * static_cast<double>(i / 10), 1e-6);
  }
  std::size_t part = 0;
  for (const test::RawMessage& message : test::readAll(file)) {
    if (message.topic != "/points") continue;
    EXPECT_NEAR(message.time.toSec(), 5.1 + 0.01 * static_cast<double>(part++), 1e-6);
  }
  const LabelBagSummary summary = expectLabelledWholly(directory, file, clouds.size());
  EXPECT_EQ(summary.evaluation.scans(), 50U) << "half a second is not scored, as with whole scans";
}

}  // namespace
}  // namespace donex
