// A small bag of very many records: checking it takes little more memory than its content.
#include <gtest/gtest.h>
#include <roslz4/lz4s.h>

#include "bag/bags.h"
#include "programs/command.h"

namespace donex {
namespace {

namespace fs = std::filesystem;

template <class Number>
std::string bytesOf(Number number) {
  return std::string(reinterpret_cast<const char*>(&number), sizeof(number));
}

std::string sized(const std::string& text) { return bytesOf(static_cast<std::uint32_t>(text.size())) + text; }

std::string field(const std::string& name, const std::string& value) { return sized(name + "=" + value); }

std::string record(char kind, const std::string& fields, const std::string& data) {
  return sized(field("op", {kind}) + fields) + sized(data);
}

std::string packed(std::string content) {
  std::string result(content.size(), '\0');
  auto size = static_cast<unsigned int>(result.size());
  constexpr int kBlock = 6;
  EXPECT_EQ(roslz4_buffToBuffCompress(content.data(), static_cast<unsigned int>(content.size()), result.data(), &size,
                                      kBlock),
            ROSLZ4_OK);
  return result.substr(0, size);
}

/// One chunk of nothing but the smallest records, 16 bytes each.
std::string bagOfSmallRecords(std::size_t count) {
  std::string content;
  for (std::size_t i = 0; i < count; ++i) content += record(2, "", "");
  EXPECT_EQ(content.size(), 16 * count);
  const auto size = bytesOf(static_cast<std::uint32_t>(content.size()));
  const std::string chunk = record(5, field("compression", "lz4") + field("size", size), packed(content));
  const auto begin = [&](std::uint64_t index) {
    return "#ROSBAG V2.0\n" + record(3,
                                     field("index_pos", bytesOf(index)) + field("conn_count", bytesOf(0U)) +
                                         field("chunk_count", bytesOf(1U)),
                                     "");
  };
  const std::uint64_t at = begin(0).size();
  const std::string info = record(6,
                                  field("ver", bytesOf(1U)) + field("chunk_pos", bytesOf(at)) +
                                      field("start_time", bytesOf(std::uint64_t{1})) +
                                      field("end_time", bytesOf(std::uint64_t{1})) + field("count", bytesOf(0U)),
                                  "");
  return begin(at + chunk.size()) + chunk + info;
}

TEST(HostileBagMemory, AChunkOfMillionsOfRecordsTakesLittleMoreThanItsContent) {
  const test::TemporaryDirectory directory;
  const fs::path file = directory.path() / "in.bag";
  constexpr std::size_t kRecords = 8000000;  // 128 MB
  test::writeText(file, bagOfSmallRecords(kRecords));
  EXPECT_LT(fs::file_size(file), 5000000U);
  const std::string run = std::string(DONEX_BAG) + " " + file.string() + " " + (directory.path() / "out.bag").string();
  const test::Outcome outcome = test::runCommand("bash -c 'ulimit -v 400000; " + run + "'");
  EXPECT_NE(outcome.text.find("has no topic of type sensor_msgs/PointCloud2"), std::string::npos) << outcome.text;
}

}  // namespace
}  // namespace donex
