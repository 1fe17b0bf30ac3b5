// Bags that cannot be labelled: each is named, and no output is left behind.
#include <csignal>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <topic_tools/shape_shifter.h>

#include "bag/bags.h"

namespace donex {
namespace {

namespace fs = std::filesystem;
using sensor_msgs::PointCloud2;

const std::string kTypes = "sensor_msgs/PointCloud2 or livox_ros_driver/CustomMsg or livox_ros_driver2/CustomMsg";

class LabelBagFaults : public testing::Test {
 protected:
  void SetUp() override {
    test::writeDriveBag(directory_.path() / "drive", in_, 3);
    fs::create_directory(out_.parent_path());
  }

  /// The message of the error; out/ must be empty after it.
  std::string fault(const LabelBagOptions& options = {}) {
    std::string message = "no error";
    try {
      test::label(in_, out_, options);
    } catch (const DataError& error) {
      message = error.what();
    }
    EXPECT_TRUE(test::filesIn(out_.parent_path()).empty());
    return message;
  }
  void expectFault(const std::string& part, const LabelBagOptions& options = {}) {
    const std::string message = fault(options);
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_NE(message.find(in_.string()), std::string::npos) << message;
  }

  test::TemporaryDirectory directory_;
  fs::path in_ = directory_.path() / "in.bag";
  fs::path out_ = directory_.path() / "out" / "out.bag";
};

void writeOnly(const fs::path& file, const std::function<void(rosbag::Bag&)>& add) {
  rosbag::Bag bag(file.string(), rosbag::bagmode::Write);
  add(bag);
}

TEST_F(LabelBagFaults, NotABag) {
  test::writeText(in_, "no bag at all");
  expectFault("is not a bag or is cut off");
}

TEST_F(LabelBagFaults, CutOff) {
  fs::resize_file(in_, fs::file_size(in_) / 2);
  expectFault("is not a bag or is cut off");
}

TEST_F(LabelBagFaults, SpoiledInside) {
  std::string bytes = test::readText(in_);
  // In the middle of the chunk of messages: lengths are rubbish there.
  bytes.replace(5000, 4000, std::string(4000, '\x7f'));
  test::writeText(in_, bytes);
  expectFault(in_.string());
}

TEST_F(LabelBagFaults, Empty) {
  writeOnly(in_, [](rosbag::Bag&) {});
  expectFault("has no topic of type " + kTypes + "; it has no topics at all");
}

TEST_F(LabelBagFaults, NoClouds) {
  writeOnly(in_, [](rosbag::Bag& bag) { bag.write("/log", ros::Time(1.0), test::text("hello")); });
  expectFault("has no topic of type " + kTypes + "; its topics are:\n  /log (std_msgs/String)");
}

TEST_F(LabelBagFaults, NoOdometry) {
  writeOnly(in_, [](rosbag::Bag& bag) { bag.write("/points", ros::Time(1.0), PointCloud2()); });
  expectFault("has no topic of type nav_msgs/Odometry");
}

TEST_F(LabelBagFaults, SeveralCandidates) {
  test::change(in_, [](rosbag::Bag& bag) { bag.write("/rear", ros::Time(50.0), PointCloud2()); });
  expectFault("has 2 topics of type " + kTypes + ", choose one with --points; its topics are:");
}

TEST_F(LabelBagFaults, NoSuchTopic) {
  LabelBagOptions options;
  options.points = "/front/points";
  expectFault("has no topic /front/points (--points); its topics are:\n  /odom (nav_msgs/Odometry)\n  /points",
              options);
}

TEST_F(LabelBagFaults, WrongType) {
  LabelBagOptions options;
  options.odom = "/points";
  expectFault("topic /points is of type sensor_msgs/PointCloud2, must be nav_msgs/Odometry", options);
}

TEST_F(LabelBagFaults, LabelsAreThereAlready) {
  LabelBagOptions options;
  options.labeled = "/tf";
  expectFault("has a topic /tf already, choose another name with --labeled", options);
}

TEST_F(LabelBagFaults, NothingCanBeLabelled) {
  const auto clouds = test::readTopic<PointCloud2>(in_, "/points");
  const auto odometry = test::readTopic<nav_msgs::Odometry>(in_, "/odom");
  writeOnly(in_, [&](rosbag::Bag& bag) {  // without tf
    for (const auto& message : clouds) bag.write("/points", message->header.stamp, message);
    for (const auto& message : odometry) bag.write("/odom", message->header.stamp, message);
  });
  expectFault("none of the 3 clouds on /points could be labelled\n  clouds dropped");
}

TEST_F(LabelBagFaults, BytesThatAreNoCloud) {
  std::vector<std::uint8_t> bytes(16, 0xFF);
  ros::serialization::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  topic_tools::ShapeShifter rubbish;
  namespace traits = ros::message_traits;
  rubbish.morph(traits::MD5Sum<PointCloud2>::value(), traits::DataType<PointCloud2>::value(),
                traits::Definition<PointCloud2>::value(), "");
  rubbish.read(stream);
  test::change(in_, [&](rosbag::Bag& bag) { bag.write("/points", ros::Time(50.15), rubbish); });
  expectFault("/points at 50.150000000 s: cannot be read");
}

TEST_F(LabelBagFaults, OutputCannotBeWritten) {
  EXPECT_THROW(test::label(in_, directory_.path() / "none" / "out.bag"), DataError);
}

/// No file of this process grows beyond that, as on a full disk.
class FullDisk {
 public:
  explicit FullDisk(std::uintmax_t most) : old_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit{most, old_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, old_handler_);
  }

 private:
  rlimit old_{};
  void (*old_handler_)(int);
};

TEST_F(LabelBagFaults, AFullDiskIsTheOutputsFault) {
  std::string message;
  {
    const FullDisk disk(fs::file_size(in_) + 2000);
    message = fault();
  }
  EXPECT_EQ(message.rfind(out_.string() + ": cannot be written (", 0), 0U) << message;
}

TEST_F(LabelBagFaults, WhatTheSinkThrowsIsNotTheInputsFault) {
  int calls = 0;
  const LabelBagSink sink = [&](const LabeledScan&, const ros::Time&, std::size_t) {
    if (++calls == 2) throw DataError("the sink's");
  };
  try {
    judgeBag({in_}, {}, sink, [](std::size_t, std::size_t) {});
    FAIL() << "nothing was thrown";
  } catch (const DataError& error) {
    EXPECT_STREQ(error.what(), "the sink's");
  }
  EXPECT_EQ(calls, 2) << "it was asked again";
}

TEST_F(LabelBagFaults, FaultyConfiguration) {
  LabelBagOptions options;
  options.config.voxel_size = -1.0;
  EXPECT_THROW(test::label(in_, out_, options), std::invalid_argument);
}

}  // namespace
}  // namespace donex
