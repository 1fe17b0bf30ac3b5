// A recording in several bags is labelled as one.
#include <gtest/gtest.h>

#include "bag/bags.h"

namespace donex {
namespace {

namespace fs = std::filesystem;
using sensor_msgs::PointCloud2;
using test::kLabeled;
using test::ScanLabels;
using test::TemporaryDirectory;

/// Splits a bag by time as a recorder does: what came first (/tf_static) is in the first part only.
BagParts split(const fs::path& in, const fs::path& directory, const std::vector<double>& ends) {
  BagParts parts;
  rosbag::Bag bag(in.string());
  for (std::size_t i = 0; i <= ends.size(); ++i) {
    parts.push_back(directory / ("part_" + std::to_string(i) + ".bag"));
    rosbag::Bag part(parts.back().string(), rosbag::bagmode::Write);
    const ros::Time from = i == 0 ? ros::TIME_MIN : ros::Time(ends[i - 1]);
    const ros::Time to = i == ends.size() ? ros::TIME_MAX : ros::Time(ends[i]) - ros::Duration(0, 1);
    rosbag::View view(bag, from, to);
    for (const rosbag::MessageInstance& message : view) {
      part.write(message.getTopic(), message.getTime(), message, message.getConnectionHeader());
    }
  }
  return parts;
}

TEST(BagParts, PartsOfARecordingAreLabelledAsOne) {
  const TemporaryDirectory directory;
  const fs::path in = directory.path() / "in.bag", whole = directory.path() / "whole.bag";
  test::writeDriveBag(directory.path() / "drive", in, 15);
  LabelBagOptions options;
  options.config = paperConfig(Method::kDonex3d);
  test::label(in, whole, options);
  const BagParts parts = split(in, directory.path(), {50.45, 51.05});
  fs::create_directory(directory.path() / "out");
  BagParts outputs;
  for (const auto& part : parts) outputs.push_back(directory.path() / "out" / part.filename());
  const auto summary = labelBag(parts, outputs, options, [](std::size_t, std::size_t) {});
  EXPECT_EQ(summary.counts.clouds_labeled, 15U);
  EXPECT_NEAR(summary.duration, 1.4, 0.01);
  ScanLabels labels, expected;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    EXPECT_TRUE(test::readAll(parts[i]) == test::readAll(outputs[i], kLabeled)) << "part " << i;
    const auto clouds = test::readTopic<PointCloud2>(outputs[i], kLabeled);
    EXPECT_FALSE(clouds.empty());
    for (const auto& cloud : clouds) labels.push_back(test::dynamicOf(*cloud));
  }
  for (const auto& cloud : test::readTopic<PointCloud2>(whole, kLabeled)) expected.push_back(test::dynamicOf(*cloud));
  EXPECT_EQ(labels, expected);
  EXPECT_GT(test::countDynamic(expected), 100) << "equal labels say little";
}

TEST(BagParts, WhatDoesNotFollowIsNoPart) {
  const TemporaryDirectory directory;
  const fs::path in = directory.path() / "in.bag";
  test::writeDriveBag(directory.path() / "drive", in, 15);
  const BagParts parts = split(in, directory.path(), {50.75});
  const BagParts backwards{parts[1], parts[0]}, outputs{directory.path() / "a.bag", directory.path() / "b.bag"};
  EXPECT_THROW(labelBag(backwards, outputs, {}, [](std::size_t, std::size_t) {}), DataError);
  EXPECT_THROW(labelBag(parts, {outputs[0]}, {}, [](std::size_t, std::size_t) {}), std::invalid_argument);
  EXPECT_FALSE(fs::exists(outputs[0]));
}

}  // namespace
}  // namespace donex
