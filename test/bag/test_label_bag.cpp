#include <gtest/gtest.h>

#include "bag/bag_file.h"
#include "bag/bags.h"
#include "evaluation/drive_run.h"

namespace donex {
namespace {

namespace fs = std::filesystem;
using sensor_msgs::PointCloud2;
using test::countDynamic;
using test::dynamicOf;
using test::kLabeled;
using test::ScanLabels;
using test::TemporaryDirectory;

/// What the detector says to the sequence itself.
ScanLabels labelsOfSequence(const fs::path& directory, const Config& config) {
  const SequenceReader sequence(directory);
  const auto detector = makeDetector(config);
  ScanLabels all;
  EchoLabels labels;
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    detector->process(toScan(sequence.scan(i)), labels);
    all.push_back(labels.dynamic);
  }
  return all;
}

TEST(LabelBag, GivesTheLabelsOfTheSequence) {
  for (const double rate : {10.0, 100.0}) {
    const TemporaryDirectory directory;
    const fs::path in = directory.path() / "in.bag", out = directory.path() / "out.bag";
    test::writeDriveBag(directory.path() / "drive", in, 15, {{rate, 0.0}, rosbag::compression::Uncompressed});
    LabelBagOptions options;
    options.config = paperConfig(Method::kDonex3d);
    const auto summary = test::label(in, out, options);
    const auto expected = labelsOfSequence(directory.path() / "drive", options.config);
    const auto clouds = test::readTopic<PointCloud2>(out, kLabeled);
    EXPECT_EQ(summary.counts.clouds_labeled, 15U);
    EXPECT_EQ(summary.counts.dropped.total(), 0U);
    ASSERT_EQ(clouds.size(), expected.size());
    for (std::size_t i = 0; i < clouds.size(); ++i) {
      EXPECT_EQ(dynamicOf(*clouds[i]), expected[i]) << "scan " << i << " at " << rate << " Hz";
    }
    EXPECT_GT(countDynamic(expected), 100) << "equal labels say little";
  }
}

/// A second listener on /odom, a latched topic, messages of equal times, and texts between.
void addOthers(rosbag::Bag& bag) {
  const auto header = boost::make_shared<ros::M_string>();
  namespace traits = ros::message_traits;
  (*header)["type"] = traits::DataType<std_msgs::String>::value();
  (*header)["md5sum"] = traits::MD5Sum<std_msgs::String>::value();
  (*header)["message_definition"] = traits::Definition<std_msgs::String>::value();
  (*header)["topic"] = "/robot_name";
  (*header)["callerid"] = "/parameters";
  (*header)["latching"] = "1";
  bag.write("/robot_name", ros::Time(50.05), test::text("rover"), header);
  for (int i = 0; i < 20; ++i) {
    const ros::Time time(50.0 + 0.07 * i);
    bag.write("/log", time, test::text("entry " + std::to_string(i)));
    bag.write("/a/second/log", time, test::text("also " + std::to_string(i)));
  }
}

TEST(LabelBag, KeepsEverythingElse) {
  for (const auto compression :
       {rosbag::compression::Uncompressed, rosbag::compression::LZ4, rosbag::compression::BZ2}) {
    const TemporaryDirectory directory;
    const fs::path in = directory.path() / "in.bag", out = directory.path() / "out.bag";
    test::writeDriveBag(directory.path() / "drive", in, 8, {{}, compression});
    test::change(in, addOthers);
    const auto summary = test::label(in, out);
    const auto before = test::readAll(in), after = test::readAll(out, kLabeled);
    EXPECT_EQ(summary.messages, before.size());
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
      EXPECT_TRUE(before[i] == after[i]) << i << ": " << before[i].topic << " became " << after[i].topic;
    }
    EXPECT_EQ(compressionOf(out), compression);
    EXPECT_EQ(test::readTopic<PointCloud2>(out, kLabeled).size(), 8U);
    EXPECT_EQ(test::filesIn(directory.path()), (std::vector<std::string>{"drive", "in.bag", "out.bag"}));
  }
}

TEST(LabelBag, LabeledCloudIsTheInputWithTwoMoreFields) {
  const TemporaryDirectory directory;
  const fs::path in = directory.path() / "in.bag", out = directory.path() / "out.bag";
  test::writeDriveBag(directory.path() / "drive", in, 3);
  test::label(in, out);
  const auto clouds = test::readTopic<PointCloud2>(in, "/points");
  const auto labeled = test::readTopic<PointCloud2>(out, kLabeled);
  ASSERT_EQ(labeled.size(), clouds.size());
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    EXPECT_EQ(labeled[i]->header.stamp, clouds[i]->header.stamp);
    EXPECT_EQ(labeled[i]->header.frame_id, clouds[i]->header.frame_id);
    EXPECT_EQ(labeled[i]->width, clouds[i]->width);
    EXPECT_EQ(labeled[i]->fields.size(), clouds[i]->fields.size() + 2);
  }
}

TEST(LabelBag, TakesTheNamedTopicsOfSeveral) {
  const TemporaryDirectory directory;
  const fs::path in = directory.path() / "in.bag", out = directory.path() / "out.bag";
  test::writeDriveBag(directory.path() / "drive", in, 3);
  test::change(in, [](rosbag::Bag& bag) {
    bag.write("/rear/points", ros::Time(50.0), PointCloud2());
    bag.write("/other/odom", ros::Time(50.0), nav_msgs::Odometry());
  });
  EXPECT_THROW(test::label(in, out), DataError);
  LabelBagOptions options;
  options.points = "points";  // without the slash too
  options.odom = "/odom";
  options.labeled = "labels";
  const auto summary = test::label(in, out, options);
  EXPECT_EQ(summary.points, "/points");
  EXPECT_EQ(summary.counts.clouds_labeled, 3U);
  EXPECT_EQ(test::readTopic<PointCloud2>(out, "/labels").size(), 3U);
}

TEST(LabelBag, MovesBySequenceOfTfAndNeedsNoOdometryThen) {
  const TemporaryDirectory directory;
  const fs::path in = directory.path() / "in.bag", out = directory.path() / "out.bag";
  test::writeDriveBag(directory.path() / "drive", in, 6);
  LabelBagOptions options;
  options.config = paperConfig(Method::kDonex3d);
  options.config.motion.source = OdometrySource::kTf;
  const auto summary = test::label(in, out, options);
  EXPECT_TRUE(summary.odom.empty());
  EXPECT_EQ(summary.counts.clouds_labeled, 6U);
  const auto expected = labelsOfSequence(directory.path() / "drive", options.config);
  const auto clouds = test::readTopic<PointCloud2>(out, kLabeled);
  ASSERT_EQ(clouds.size(), 6U);
  for (std::size_t i = 0; i < clouds.size(); ++i) EXPECT_EQ(dynamicOf(*clouds[i]), expected[i]);
  EXPECT_GT(countDynamic(expected), 100) << "equal labels say little";
}

TEST(LabelBag, FindsOutWhatABagTellsOfTheMotionAndSaysWhy) {
  const TemporaryDirectory directory;
  const fs::path in = directory.path() / "in.bag", out = directory.path() / "out.bag";
  test::writeDriveBag(directory.path() / "drive", in, 6);
  const fs::path only_tf = directory.path() / "only_tf.bag";
  {
    rosbag::Bag from(in.string(), rosbag::bagmode::Read), to(only_tf.string(), rosbag::bagmode::Write);
    for (const rosbag::MessageInstance& message : rosbag::View(from)) {
      const bool is_odometry = message.getDataType() == "nav_msgs/Odometry";
      if (!is_odometry) to.write(message.getTopic(), message.getTime(), message, message.getConnectionHeader());
    }
  }
  LabelBagOptions options;
  options.config.motion.source = OdometrySource::kAuto;
  const auto with_odometry = test::label(in, out, options);
  EXPECT_NE(with_odometry.motion.find("poses of odometry on /odom (chosen: the bag holds odometry"), std::string::npos)
      << with_odometry.motion;
  const auto by_tf = test::label(only_tf, directory.path() / "by_tf.bag", options);
  EXPECT_EQ(by_tf.counts.clouds_labeled, 6U);
  EXPECT_NE(by_tf.motion.find("tf, base_link in odom (chosen: the bag holds no nav_msgs/Odometry"), std::string::npos)
      << by_tf.motion;
  options.config.motion.fixed_frame = "map";
  const auto by_clouds = test::label(only_tf, directory.path() / "by_clouds.bag", options);
  EXPECT_NE(by_clouds.motion.find("does not know base_link in map; otherwise set fixed_frame"), std::string::npos)
      << by_clouds.motion;
}

TEST(LabelBag, WhatIsDroppedIsCountedAndExplained) {
  const TemporaryDirectory directory;
  const fs::path in = directory.path() / "in.bag", out = directory.path() / "out.bag";
  test::writeDriveBag(directory.path() / "drive", in, 4);
  test::change(in, [](rosbag::Bag& bag) {
    PointCloud2 cloud;  // no fields at all
    cloud.header.stamp = ros::Time(50.25);
    cloud.width = cloud.height = 1;
    bag.write("/points", ros::Time(50.25), cloud);
    nav_msgs::Odometry odometry;
    odometry.header.stamp = ros::Time(50.25);
    odometry.header.frame_id = "odom";
    odometry.child_frame_id = "base_link";
    bag.write("/odom", ros::Time(50.25), odometry);  // its quaternion is zero
  });
  const auto summary = test::label(in, out);
  EXPECT_EQ(summary.counts.clouds_in, 5U);
  EXPECT_EQ(summary.counts.clouds_labeled, 4U);
  EXPECT_EQ(summary.counts.dropped.total(), 1U);
  EXPECT_EQ(summary.counts.refused.total(), 1U);
  EXPECT_EQ(summary.remarks.size(), 3U) << "also that the clouds carry no times";
}

TEST(LabelBag, WholeDriveMethodsReadTheBagSeveralTimes) {
  const TemporaryDirectory directory;
  const fs::path in = directory.path() / "in.bag", out = directory.path() / "out.bag";
  test::writeDriveBag(directory.path() / "drive", in, 8);
  LabelBagOptions options;
  options.config.method = Method::kPeopleremover;
  options.config.voxel_size = 2.0;  // the drive is random: only large voxels are seen through often
  const auto summary = test::label(in, out, options);
  EXPECT_EQ(summary.counts.clouds_in, 8U);
  EXPECT_EQ(summary.counts.clouds_labeled, 8U);
  const auto clouds = test::readTopic<PointCloud2>(out, kLabeled);
  ASSERT_EQ(clouds.size(), 8U);
  const SequenceReader sequence(directory.path() / "drive");
  DriveRun drive(options.config);
  long dynamic = 0;
  const auto compare = [&](std::size_t i, const Scan&, const EchoLabels& labels) {
    EXPECT_EQ(dynamicOf(*clouds[i]), labels.dynamic) << "scan " << i;
    dynamic += std::count(labels.dynamic.begin(), labels.dynamic.end(), 1);
  };
  drive.run(sequence, sequence.size(), compare, [] {});
  EXPECT_GT(dynamic, 10);
}

TEST(LabelBag, TheNodeRefusesWhatCannotRunLive) {
  const tf2::BufferCore tf;
  Config config;
  config.method = Method::kPeopleremover;
  EXPECT_THROW(Pipeline(config, tf, {}), std::invalid_argument);
}

}  // namespace
}  // namespace donex
