// Bags that lie about themselves: each is refused before the rosbag library follows it.
#include <cstring>
#include <random>

#include <gtest/gtest.h>
#include <tf2_msgs/TFMessage.h>
#include <topic_tools/shape_shifter.h>

#include "bag/bag_check.h"
#include "bag/bags.h"

namespace donex {
namespace {

namespace fs = std::filesystem;

class BagCheckTest : public testing::Test {
 protected:
  void write(rosbag::CompressionType compression = rosbag::compression::Uncompressed) {
    SequenceBagOptions options;
    options.compression = compression;
    test::writeDriveBag(directory_.path() / "drive", file_, 2, options);
    bytes_ = test::readText(file_);
  }
  /// Where the first field of that name has its value.
  std::size_t valueOf(const std::string& name, std::size_t bytes, std::size_t from = 0) const {
    const auto length = static_cast<char>(name.size() + 1 + bytes);
    const std::string field = std::string(1, length) + std::string(3, '\0') + name + "=";
    const std::size_t at = bytes_.find(field, from);
    EXPECT_NE(at, std::string::npos) << name;
    return at + field.size();
  }
  template <class Number>
  Number get(std::size_t at) const {
    Number number{};
    std::memcpy(&number, bytes_.data() + at, sizeof(number));
    return number;
  }
  template <class Number>
  void put(std::size_t at, Number number) {
    std::memcpy(bytes_.data() + at, &number, sizeof(number));
  }
  std::size_t indexPosition() const { return get<std::uint64_t>(valueOf("index_pos", 8)); }

  void expectFault(const std::string& part) {
    test::writeText(file_, bytes_);
    try {
      checkBag(file_);
      FAIL() << "passed";
    } catch (const DataError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(file_.string()), std::string::npos) << error.what();
    }
  }

  test::TemporaryDirectory directory_;
  fs::path file_ = directory_.path() / "in.bag";
  std::string bytes_;
};

constexpr std::uint32_t kHuge = 4000000000U;

TEST_F(BagCheckTest, SoundBagsPass) {
  for (const auto compression :
       {rosbag::compression::Uncompressed, rosbag::compression::LZ4, rosbag::compression::BZ2}) {
    write(compression);
    EXPECT_NO_THROW(checkBag(file_));
    fs::remove_all(directory_.path() / "drive");
  }
}

TEST_F(BagCheckTest, ABagWithoutAnIndexIsTheLibrarysToRefuse) {
  write();
  put(valueOf("index_pos", 8), std::uint64_t{0});
  test::writeText(file_, bytes_);
  EXPECT_NO_THROW(checkBag(file_));
}

TEST_F(BagCheckTest, ARecordLongerThanTheFile) {
  write();
  put(indexPosition(), kHuge);
  expectFault("a connection is missing or cut off");
}

TEST_F(BagCheckTest, AnIndexBeyondTheFile) {
  write();
  put(valueOf("index_pos", 8), ~std::uint64_t{0});
  expectFault("a connection is missing or cut off");
}

TEST_F(BagCheckTest, MoreChunksThanThereAre) {
  write();
  put(valueOf("chunk_count", 4), kHuge);
  expectFault("the summary of a chunk is missing or cut off");
}

TEST_F(BagCheckTest, AChunkThatClaimsGigabytes) {
  for (const auto compression :
       {rosbag::compression::Uncompressed, rosbag::compression::LZ4, rosbag::compression::BZ2}) {
    write(compression);
    put(valueOf("size", 4), kHuge);
    expectFault("a chunk of 4000000000 bytes");
    put(valueOf("size", 4), std::uint32_t{1000000000});
    expectFault("a chunk of");
    fs::remove_all(directory_.path() / "drive");
  }
}

TEST_F(BagCheckTest, AMessageLongerThanItsChunk) {
  write();
  const std::size_t time = valueOf("time", 8);  // the last field of the first message; the length of its data follows
  put(time + sizeof(std::uint64_t), kHuge);
  expectFault("a chunk whose content is no record");
}

TEST_F(BagCheckTest, AnIndexThatLeadsBesideAMessage) {
  write();
  const std::size_t version = valueOf("ver", 4);  // the last field of an index; length, seconds, nanoseconds follow
  const std::size_t offset = version + 4 * sizeof(std::uint32_t);
  put(offset, get<std::uint32_t>(offset) + 1);
  expectFault("an index that leads to no message");
  put(offset, kHuge);
  expectFault("an index that leads to no message");
}

TEST_F(BagCheckTest, CountsThatAreNotThere) {
  write();
  const std::string whole = bytes_;
  put(valueOf("count", 4), kHuge);
  expectFault("an index that counts more than it holds");
  bytes_ = whole;
  put(valueOf("count", 4, indexPosition()), kHuge);
  expectFault("a summary that counts more than it holds");
}

TEST_F(BagCheckTest, AChunkSomewhereElse) {
  write();
  put(valueOf("chunk_pos", 8), std::uint64_t{100});
  expectFault("a chunk is missing or cut off");
}

TEST_F(BagCheckTest, AnyByteMayBeWrong) {
  for (const auto compression :
       {rosbag::compression::Uncompressed, rosbag::compression::LZ4, rosbag::compression::BZ2}) {
    write(compression);
    const std::string whole = bytes_;
    LabelBagOptions options;
    options.config.region = {-10.0, 10.0, -10.0, 10.0, -2.0, 2.0};  // a small grid: quick to build
    std::mt19937 random(3);
    std::size_t refused = 0;
    for (int i = 0; i < 100; ++i) {
      bytes_ = whole;
      const std::size_t at = random() % bytes_.size();
      bytes_[at] = static_cast<char>(random() % 4 == 0 ? 0xFF : random());
      test::writeText(file_, bytes_);
      try {
        test::label(file_, directory_.path() / "out.bag", options);
      } catch (const DataError&) {
        ++refused;
      }
    }
    EXPECT_GT(refused, 0U);
    fs::remove_all(directory_.path() / "drive");
  }
}

/// A message of that type with those bytes in a bag that is sound otherwise: what reading it says.
template <class Message>
std::string readingOf(const std::string& topic, const std::vector<std::uint32_t>& numbers) {
  const test::TemporaryDirectory directory;
  const fs::path file = directory.path() / "in.bag";
  test::writeDriveBag(directory.path() / "drive", file, 2);
  std::vector<std::uint32_t> copy = numbers;
  ros::serialization::IStream stream(reinterpret_cast<std::uint8_t*>(copy.data()),
                                     static_cast<std::uint32_t>(copy.size() * sizeof(copy[0])));
  topic_tools::ShapeShifter message;
  namespace traits = ros::message_traits;
  message.morph(traits::MD5Sum<Message>::value(), traits::DataType<Message>::value(),
                traits::Definition<Message>::value(), "");
  message.read(stream);
  test::change(file, [&](rosbag::Bag& bag) { bag.write(topic, ros::Time(50.15), message); });
  try {
    test::label(file, directory.path() / "out.bag");
  } catch (const DataError& error) {
    return error.what();
  }
  return "no error";
}

TEST(HostileMessages, WhatTheyClaimIsNotAllocated) {
  using sensor_msgs::PointCloud2;
  // seq, stamp, frame, height, width, fields
  const std::string fields = readingOf<PointCloud2>("/points", {0, 50, 0, 0, 1, 1, kHuge, 0, 0, 0});
  EXPECT_NE(fields.find("/points at 50.150000000 s: cannot be read"), std::string::npos) << fields;
  const std::string transforms = readingOf<tf2_msgs::TFMessage>("/tf", {kHuge, 0, 0, 0, 0});
  EXPECT_NE(transforms.find("/tf at 50.150000000 s: cannot be read"), std::string::npos) << transforms;
}

}  // namespace
}  // namespace donex
