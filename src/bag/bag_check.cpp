#include "bag/bag_check.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <new>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <bzlib.h>
#include <fmt/format.h>
#include <roslz4/lz4s.h>

#include "bag/bag_record.h"

namespace donex {
namespace {

namespace fs = std::filesystem;
using bag::Record;
using bag::RecordSource;
/// Of records in a chunk's content, rising. A chunk may hold millions of records of sixteen bytes.
using Positions = std::vector<std::uint32_t>;

constexpr std::string_view kVersion = "#ROSBAG V2.0\n";

/// A chunk's data, decompressed. No vector: where a chunk only claims to be large, nothing is written.
struct Free {
  void operator()(char* memory) const { std::free(memory); }
};
using Content = std::unique_ptr<char, Free>;

class BagCheck {
 public:
  explicit BagCheck(const fs::path& file) : name_(file.string()), stream_(file, std::ios::binary) {
    source_.size = fs::file_size(file);
    source_.read = [this](std::uint64_t at, char* to, std::size_t count) { readBytes(at, to, count); };
  }

  void run();

 private:
  void checkConnection(const Record& record);
  void checkChunkOf(const Record& info);
  std::uint64_t checkIndex(std::uint64_t at, const Positions& messages);
  Positions messagesIn(const Record& chunk);
  Positions messagesIn(const RecordSource& source, std::uint64_t chunk);
  Content decompressed(const Record& chunk, std::uint32_t size);

  Record require(std::uint64_t at, char kind, const char* what);
  template <class Number>
  Number requireNumber(const Record& record, const char* field);
  void readBytes(std::uint64_t at, char* to, std::size_t count);
  std::string readText(std::uint64_t at, std::size_t count);
  [[noreturn]] void fail(std::uint64_t at, const std::string& what) const {
    throw DataError(fmt::format("{}: is not a bag or is cut off (byte {}: {})", name_, at, what));
  }

  std::string name_;
  std::ifstream stream_;
  RecordSource source_;
  std::set<std::uint64_t> chunks_;
};

void BagCheck::run() {
  const bool is_bag = source_.size >= kVersion.size() && readText(0, kVersion.size()) == kVersion;
  if (!is_bag) throw DataError(name_ + ": is not a bag or is cut off (it does not begin as bags of version 2.0 do)");
  const Record header = require(kVersion.size(), bag::kBagHeader, "the header of the bag");
  const bool is_encrypted = !header.text("encryptor").empty();
  if (is_encrypted) throw DataError(name_ + ": is encrypted; 'rosbag decrypt' makes one of it that can be read");
  auto at = requireNumber<std::uint64_t>(header, "index_pos");
  if (at == 0) return;  // no index
  const auto connections = requireNumber<std::uint32_t>(header, "conn_count");
  const auto chunks = requireNumber<std::uint32_t>(header, "chunk_count");
  for (std::uint32_t i = 0; i < connections; ++i) {
    const Record record = require(at, bag::kConnection, "a connection");
    checkConnection(record);
    at = record.end();
  }
  for (std::uint32_t i = 0; i < chunks; ++i) {
    const Record record = require(at, bag::kChunkInfo, "the summary of a chunk");
    checkChunkOf(record);
    at = record.end();
  }
}

void BagCheck::checkConnection(const Record& record) {
  requireNumber<std::uint32_t>(record, "conn");
  if (!bag::parseFields(readText(record.data, record.data_size)))
    fail(record.data, "a connection whose fields are longer than itself");
}

void BagCheck::checkChunkOf(const Record& info) {
  constexpr std::uint32_t kBytesEach = 8;
  const auto connections = requireNumber<std::uint32_t>(info, "count");
  if (info.data_size / kBytesEach < connections) fail(info.begin, "a summary that counts more than it holds");
  const auto position = requireNumber<std::uint64_t>(info, "chunk_pos");
  if (!chunks_.insert(position).second) fail(info.begin, "a second summary of one chunk");
  const Record chunk = require(position, bag::kChunk, "a chunk");
  const Positions messages = messagesIn(chunk);
  std::uint64_t at = chunk.end();
  for (std::uint32_t i = 0; i < connections; ++i) at = checkIndex(at, messages);
}

/// Returns where the next one begins.
std::uint64_t BagCheck::checkIndex(std::uint64_t at, const Positions& messages) {
  constexpr std::uint32_t kBytesEach = 12, kOffsetAt = 8;  // seconds, nanoseconds, offset
  const Record record = require(at, bag::kIndex, "the index of a chunk");
  const auto count = requireNumber<std::uint32_t>(record, "count");
  if (record.data_size / kBytesEach < count) fail(at, "an index that counts more than it holds");
  const std::string entries = readText(record.data, record.data_size);
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto offset = bag::numberIn<std::uint32_t>(entries.substr(i * kBytesEach + kOffsetAt, sizeof(std::uint32_t)));
    if (!std::binary_search(messages.begin(), messages.end(), *offset)) fail(at, "an index that leads to no message");
  }
  return record.end();
}

/// Where the messages of a chunk begin in its content, and the connections before them: the library passes over a
/// connection to the message behind it.
Positions BagCheck::messagesIn(const Record& chunk) {
  constexpr std::uint32_t kMost = 1U << 30U;  // a scan of the densest sensor takes a hundredth of it
  const auto size = requireNumber<std::uint32_t>(chunk, "size");
  if (std::max(size, chunk.data_size) > kMost) fail(chunk.begin, fmt::format("a chunk of {} bytes", size));
  if (chunk.text("compression") == "none") {
    if (size != chunk.data_size) fail(chunk.begin, "a chunk of another size than it says");
    const auto read = [&](std::uint64_t at, char* to, std::size_t count) { readBytes(chunk.data + at, to, count); };
    return messagesIn({size, read}, chunk.begin);
  }
  const Content content = decompressed(chunk, size);
  const auto read = [&](std::uint64_t at, char* to, std::size_t count) { std::copy_n(content.get() + at, count, to); };
  return messagesIn({size, read}, chunk.begin);
}

Positions BagCheck::messagesIn(const RecordSource& source, std::uint64_t chunk) {
  Positions records;
  std::size_t with_message = 0;  // records behind the last message lead to none
  for (std::uint64_t at = 0; at < source.size;) {
    const auto record = bag::readRecord(source, at);
    if (!record) fail(chunk, fmt::format("a chunk whose content is no record at {}", at));
    const bool is_message = record->kind() == bag::kMessage;
    if (is_message || record->kind() == bag::kConnection) records.push_back(static_cast<std::uint32_t>(at));
    if (is_message) with_message = records.size();
    at = record->end();
  }
  records.resize(with_message);
  return records;
}

Content BagCheck::decompressed(const Record& chunk, std::uint32_t size) {
  const std::string compression = chunk.text("compression");
  std::string packed = readText(chunk.data, chunk.data_size);
  Content content(static_cast<char*>(std::malloc(std::max(size, 1U))));
  if (content == nullptr) throw std::bad_alloc();
  unsigned int unpacked = size;
  bool is_sound = false;
  if (compression == "lz4") {
    is_sound = roslz4_buffToBuffDecompress(packed.data(), chunk.data_size, content.get(), &unpacked) == ROSLZ4_OK;
  } else if (compression == "bz2") {
    is_sound = BZ2_bzBuffToBuffDecompress(content.get(), &unpacked, packed.data(), chunk.data_size, 0, 0) == BZ_OK;
  }
  if (!is_sound || unpacked != size)
    fail(chunk.begin, fmt::format("a chunk of {} bytes that does not hold the {} that it says", chunk.data_size, size));
  return content;
}

Record BagCheck::require(std::uint64_t at, char kind, const char* what) {
  const auto record = bag::readRecord(source_, at);
  if (!record || record->kind() != kind) fail(at, fmt::format("{} is missing or cut off", what));
  return *record;
}

template <class Number>
Number BagCheck::requireNumber(const Record& record, const char* field) {
  const auto number = record.number<Number>(field);
  if (!number) fail(record.begin, fmt::format("field '{}' is missing or of another size", field));
  return *number;
}

void BagCheck::readBytes(std::uint64_t at, char* to, std::size_t count) {
  stream_.seekg(static_cast<std::streamoff>(at));
  if (!stream_.read(to, static_cast<std::streamsize>(count))) throw DataError(name_ + ": cannot be read to its end");
}

std::string BagCheck::readText(std::uint64_t at, std::size_t count) {
  std::string text(count, '\0');
  readBytes(at, text.data(), count);
  return text;
}

}  // namespace

void checkBag(const fs::path& file) { BagCheck(file).run(); }

}  // namespace donex
