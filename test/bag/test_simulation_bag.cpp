// A simulated drive as a bag.
#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/PointCloud2.h>

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

}  // namespace
}  // namespace donex
