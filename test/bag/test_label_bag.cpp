#include <gtest/gtest.h>

#include "bag/bags.h"
#include "donex/bag/bag_file.h"
#include "donex/io/drive_run.h"

namespace donex {
namespace {

namespace fs = std::filesystem;
using sensor_msgs::PointCloud2;
using test::TemporaryDirectory;
constexpr const char* kLabeled = "/donex/labeled_points";

/// The bytes of the field `dynamic`.
std::vector<std::uint8_t> dynamicOf(const PointCloud2& cloud) {
  std::vector<std::uint8_t> labels;
  for (const auto& field : cloud.fields) {
    if (field.name != "dynamic") continue;
    for (std::size_t i = 0; i < cloud.width; ++i) labels.push_back(cloud.data[i * cloud.point_step + field.offset]);
  }
  return labels;
}

using ScanLabels = std::vector<std::vector<std::uint8_t>>;  // one an echo, scan by scan

long countDynamic(const ScanLabels& labels) {
  long count = 0;
  for (const auto& scan : labels) count += std::count(scan.begin(), scan.end(), 1);
  return count;
}

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
  EXPECT_EQ(summary.remarks.size(), 2U);
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

TEST(LabelBag, PartsOfARecordingAreLabelledAsOne) {
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
    for (const auto& cloud : clouds) labels.push_back(dynamicOf(*cloud));
  }
  for (const auto& cloud : test::readTopic<PointCloud2>(whole, kLabeled)) expected.push_back(dynamicOf(*cloud));
  EXPECT_EQ(labels, expected);
  EXPECT_GT(countDynamic(expected), 100) << "equal labels say little";
}

TEST(LabelBag, WhatDoesNotFollowIsNoPart) {
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
