#include <gtest/gtest.h>
#include <unistd.h>

#include "bag/bag_file.h"
#include "bag/bags.h"

namespace donex {
namespace {

namespace fs = std::filesystem;
using test::TemporaryDirectory;

void writeBag(const fs::path& file, rosbag::CompressionType compression) {
  BagWriter writer(file, compression);
  for (std::uint32_t i = 1; i < 50; ++i) {
    writer.write("/text", ros::Time(i, 0), test::text(std::string(1000, 'a')));
  }
  writer.commit();
}

TEST(BagFile, TellsTheCompression) {
  const TemporaryDirectory directory;
  const std::vector<std::string> names{"none", "lz4", "bz2"};
  for (const std::string& name : names) {
    writeBag(directory.path() / name, parseCompression(name));
    EXPECT_EQ(compressionOf(directory.path() / name), parseCompression(name)) << name;
    EXPECT_EQ(test::readAll(directory.path() / name).size(), 49U);
  }
  EXPECT_LT(fs::file_size(directory.path() / "lz4"), fs::file_size(directory.path() / "none") / 2);
}

TEST(BagFile, AnEmptyBagIsNotCompressed) {
  const TemporaryDirectory directory;
  BagWriter(directory.path() / "empty.bag", rosbag::compression::LZ4).commit();
  EXPECT_EQ(compressionOf(directory.path() / "empty.bag"), rosbag::compression::Uncompressed);
}

TEST(BagFile, UnknownCompressionIsRefused) { EXPECT_THROW(parseCompression("zip"), std::invalid_argument); }

std::string faultOf(const fs::path& file) {
  rosbag::Bag bag;
  try {
    openBag(file, bag);
  } catch (const DataError& error) {
    return error.what();
  }
  return "";
}

TEST(BagFile, SaysWhatIsWrong) {
  const TemporaryDirectory directory;
  const fs::path file = directory.path() / "drive.bag";
  writeBag(file, rosbag::compression::Uncompressed);
  EXPECT_EQ(faultOf(file), "");
  const std::string sound = test::readText(file);

  EXPECT_EQ(faultOf(directory.path() / "none.bag"), (directory.path() / "none.bag").string() + ": does not exist");
  EXPECT_NE(faultOf(directory.path()).find("is not a file"), std::string::npos);
  for (const std::string& rubbish : {std::string(), std::string("just text\n"), std::string(5000, 'x')}) {
    test::writeText(file, rubbish);
    EXPECT_NE(faultOf(file).find(file.string() + ": "), std::string::npos) << faultOf(file);
  }
}

TEST(BagFile, CutAnywhereItIsRefused) {
  const TemporaryDirectory directory;
  const fs::path file = directory.path() / "drive.bag";
  writeBag(file, rosbag::compression::Uncompressed);
  const std::string sound = test::readText(file);
  for (std::size_t length = 1; length < sound.size(); length += 997) {
    test::writeText(file, sound.substr(0, length));
    EXPECT_NE(faultOf(file).find(file.string()), std::string::npos) << "cut at " << length;
  }
}

TEST(BagFile, WithoutAnIndexItSaysHowToSaveIt) {
  const TemporaryDirectory directory;
  const fs::path file = directory.path() / "drive.bag";
  writeBag(file, rosbag::compression::Uncompressed);
  std::string bytes = test::readText(file);
  const std::string field = "index_pos=";
  bytes.replace(bytes.find(field) + field.size(), 8, std::string(8, '\0'));  // as a recorder that was killed leaves it
  test::writeText(file, bytes);
  EXPECT_NE(faultOf(file).find("rosbag reindex"), std::string::npos) << faultOf(file);
}

TEST(BagWriter, WithoutCommitNothingChanges) {
  const TemporaryDirectory directory;
  const fs::path file = directory.path() / "out.bag";
  test::writeText(file, "what was there");
  {
    BagWriter writer(file, rosbag::compression::Uncompressed);
    writer.write("/text", ros::Time(1, 0), test::text("a"));
  }
  EXPECT_EQ(test::filesIn(directory.path()), std::vector<std::string>{"out.bag"});
  EXPECT_EQ(test::readText(file), "what was there");
}

TEST(BagWriter, CommitReplacesTheOldFile) {
  const TemporaryDirectory directory;
  const fs::path file = directory.path() / "out.bag";
  test::writeText(file, "what was there");
  writeBag(file, rosbag::compression::Uncompressed);
  EXPECT_EQ(test::filesIn(directory.path()), std::vector<std::string>{"out.bag"});
  EXPECT_EQ(test::readAll(file).size(), 49U);
}

/// What lies between a bag's header, which tells where the index is, and that index: the chunks of messages.
std::string chunksOf(const fs::path& file) {
  constexpr std::size_t kHeader = 13 + 2 * sizeof(std::uint32_t) + 4096;  // "#ROSBAG V2.0\n", a padded record
  const std::string bytes = test::readText(file), field = "index_pos=";
  std::uint64_t index = 0;
  bytes.copy(reinterpret_cast<char*>(&index), sizeof(index), bytes.find(field) + field.size());
  return bytes.substr(kHeader, index - kHeader);
}

TEST(BagWriter, ACopyIsTheSameBytesUpToTheIndex) {
  const TemporaryDirectory directory;
  const fs::path original = directory.path() / "in.bag", copy = directory.path() / "out.bag";
  writeBag(original, rosbag::compression::LZ4);
  fs::permissions(original, fs::perms::owner_read);
  BagWriter writer(copy, original);
  writer.write("/more", ros::Time(100, 0), test::text("b"));
  writer.commit();
  EXPECT_EQ(compressionOf(copy), rosbag::compression::LZ4);
  const std::string chunks = chunksOf(original);
  EXPECT_GT(chunks.size(), 300U);
  EXPECT_EQ(chunksOf(copy).substr(0, chunks.size()), chunks);
  EXPECT_EQ(test::readAll(copy, "/more"), test::readAll(original));
  EXPECT_EQ(test::readAll(copy).size(), 50U);
}

TEST(BagWriter, WhatAKilledRunLeftIsNotInTheWay) {
  const TemporaryDirectory directory;
  const fs::path original = directory.path() / "in.bag", copy = directory.path() / "out.bag";
  writeBag(original, rosbag::compression::Uncompressed);
  test::writeText(copy.string() + "." + std::to_string(getpid()) + ".part", "left by another process of this number");
  BagWriter(copy, original).commit();
  EXPECT_EQ(test::readAll(copy), test::readAll(original));
}

TEST(BagWriter, ConnectionsNumberedOtherwiseAreRefusedNotMixed) {
  const TemporaryDirectory directory;
  const fs::path original = directory.path() / "in.bag";
  writeBag(original, rosbag::compression::Uncompressed);
  std::string bytes = test::readText(original);
  const std::string field = "conn=";
  for (std::size_t at = 0; (at = bytes.find(field, at)) != std::string::npos; at += field.size()) {
    bytes[at + field.size()] = 1;  // the only connection, number 0
  }
  test::writeText(original, bytes);
  ASSERT_EQ(test::readAll(original).size(), 49U);
  EXPECT_THROW(BagWriter(directory.path() / "out.bag", original), DataError);
  EXPECT_EQ(test::filesIn(directory.path()), std::vector<std::string>{"in.bag"});
}

TEST(BagWriter, NoSuchDirectoryIsNamed) {
  const TemporaryDirectory directory;
  const fs::path file = directory.path() / "none" / "out.bag";
  try {
    const BagWriter writer(file, rosbag::compression::Uncompressed);
    FAIL() << "it was opened";
  } catch (const DataError& error) {
    EXPECT_EQ(std::string(error.what()).rfind(file.string() + ": cannot be written (", 0), 0U) << error.what();
  }
}

}  // namespace
}  // namespace donex
