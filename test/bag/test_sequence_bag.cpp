#include <gtest/gtest.h>
#include <tf2_msgs/TFMessage.h>

#include "bag/bags.h"

namespace donex {
namespace {

using sensor_msgs::PointCloud2;
using test::TemporaryDirectory;

Pose poseOf(const nav_msgs::Odometry& message) {
  const auto& p = message.pose.pose.position;
  const auto& q = message.pose.pose.orientation;
  return {{p.x, p.y, p.z}, {q.w, q.x, q.y, q.z}};
}

TEST(SequenceBag, HoldsCloudsAndOdometryOfTheScans) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "drive.bag";
  test::writeDriveBag(directory.path() / "drive", file, 7);
  const SequenceReader sequence(directory.path() / "drive");
  const auto clouds = test::readTopic<PointCloud2>(file, "/points");
  const auto odometry = test::readTopic<nav_msgs::Odometry>(file, "/odom");
  ASSERT_EQ(clouds.size(), 7U);
  ASSERT_EQ(odometry.size(), 7U);
  for (std::size_t i = 0; i < 7; ++i) {
    const std::string name = "velodyne/" + scanName(i) + ".bin";
    EXPECT_EQ(std::string(clouds[i]->data.begin(), clouds[i]->data.end()),
              test::readText(directory.path() / "drive" / name));
    EXPECT_EQ(clouds[i]->header.stamp.toSec(), sequence.stamp(i));
    EXPECT_EQ(odometry[i]->header.stamp, clouds[i]->header.stamp);
    EXPECT_EQ(poseOf(*odometry[i]).isometry().matrix(), sequence.pose(i).isometry().matrix());
    EXPECT_EQ(odometry[i]->header.frame_id, "odom");
    EXPECT_EQ(odometry[i]->child_frame_id, "base_link");
    EXPECT_EQ(clouds[i]->header.frame_id, "velodyne");
  }
}

TEST(SequenceBag, MountingIsLatchedAndFirst) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "drive.bag";
  test::writeDriveBag(directory.path() / "drive", file, 2);
  const auto messages = test::readAll(file);
  EXPECT_EQ(messages.front().topic, "/tf_static");
  EXPECT_EQ(messages.front().header.at("latching"), "1");
  const auto mounting = test::readTopic<tf2_msgs::TFMessage>(file, "/tf_static");
  ASSERT_EQ(mounting.size(), 1U);
  EXPECT_EQ(mounting[0]->transforms.at(0).header.frame_id, "base_link");
  EXPECT_EQ(mounting[0]->transforms.at(0).child_frame_id, "velodyne");
  EXPECT_EQ(test::readTopic<tf2_msgs::TFMessage>(file, "/tf").size(), 2U);
}

TEST(SequenceBag, HasTheRateOfOdometryThatIsAskedFor) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "drive.bag";
  test::writeDriveBag(directory.path() / "drive", file, 11, {{100.0, 0.0}, rosbag::compression::LZ4});
  EXPECT_EQ(test::readTopic<nav_msgs::Odometry>(file, "/odom").size(), 101U);
}

/// Each scan's echoes once, the parts of its stamp at times of their own, and every part labelled.
TEST(SequenceBag, ScansMayBeSentInParts) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "drive.bag", out = directory.path() / "out.bag";
  constexpr std::size_t kScans = 6, kParts = 10;
  SequenceBagOptions options;
  options.parts = kParts;
  test::writeDriveBag(directory.path() / "drive", file, kScans, options);
  const SequenceReader sequence(directory.path() / "drive");
  const auto clouds = test::readTopic<PointCloud2>(file, "/points");
  ASSERT_EQ(clouds.size(), kScans * kParts);
  for (std::size_t i = 0; i < kScans; ++i) {
    std::size_t echoes = 0;
    for (std::size_t k = 0; k < kParts; ++k) {
      echoes += clouds[i * kParts + k]->width;
      EXPECT_EQ(clouds[i * kParts + k]->header.stamp, ros::Time(sequence.stamp(i)));
    }
    EXPECT_EQ(echoes, sequence.scan(i).echoes.size());
  }
  rosbag::Bag bag(file.string());
  rosbag::View view(bag, rosbag::TopicQuery("/points"));
  EXPECT_NEAR((view.getEndTime() - view.getBeginTime()).toSec(), 0.1 * (kScans - 0.1), 1e-5);
  EXPECT_EQ(test::label(file, out).counts.clouds_labeled, kScans * kParts);
}

TEST(SequenceBag, TimesThatABagCannotHoldAreMoved) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "drive.bag";
  test::writeSoundSequence(directory.path() / "drive", 3);  // begins at 0 s
  const SequenceReader sequence(directory.path() / "drive");
  const auto summary = writeSequenceBag(sequence, file, {}, [] {});
  EXPECT_EQ(summary.shift, 1.0);
  const auto clouds = test::readTopic<PointCloud2>(file, "/points");
  ASSERT_EQ(clouds.size(), 3U);
  EXPECT_EQ(clouds[0]->header.stamp, ros::Time(1, 0));
  EXPECT_EQ(clouds[2]->header.stamp, ros::Time(1, 200000000));
}

TEST(SequenceBag, TimesThatCannotBeSecondsAreNamed) {
  const TemporaryDirectory directory;
  test::writeSoundSequence(directory.path() / "drive", 2);
  for (const char* times : {"5e9\n6e9\n", "1\n1e8\n"}) {
    test::writeText(directory.path() / "drive" / "times.txt", times);
    EXPECT_THROW(writeSequenceBag(SequenceReader(directory.path() / "drive"), directory.path() / "a.bag", {}, [] {}),
                 DataError);
  }
  EXPECT_EQ(test::filesIn(directory.path()), std::vector<std::string>{"drive"});
}

}  // namespace
}  // namespace donex
