// A record of a bag, as wiki.ros.org/Bags/Format/2.0 has it: a header of name=value fields, and data.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

namespace donex::bag {

constexpr char kMessage = 2, kBagHeader = 3, kIndex = 4, kChunk = 5, kChunkInfo = 6, kConnection = 7;

/// A bag's numbers are little-endian, as the machines that ROS 1 runs on.
template <class Number>
std::optional<Number> numberIn(const std::string& bytes) {
  Number number{};
  if (bytes.size() != sizeof(number)) return std::nullopt;
  bytes.copy(reinterpret_cast<char*>(&number), sizeof(number));
  return number;
}

struct Record {
  std::map<std::string, std::string> fields;
  std::uint64_t begin = 0;  ///< of the record, in the file or chunk
  std::uint64_t data = 0;   ///< where its data begin
  std::uint32_t data_size = 0;

  std::uint64_t end() const { return data + data_size; }

  /// What kind of record it is; 0 where it does not say.
  char kind() const {
    const auto op = fields.find("op");
    return op == fields.end() || op->second.size() != 1 ? '\0' : op->second[0];
  }
  std::string text(const std::string& name) const {
    const auto field = fields.find(name);
    return field == fields.end() ? std::string() : field->second;
  }
  /// Empty where there is no such field, or one of another size.
  template <class Number>
  std::optional<Number> number(const std::string& name) const {
    return numberIn<Number>(text(name));
  }
};

/// Bytes that records are read from: `size` of them, and how to get some that are there.
struct RecordSource {
  std::uint64_t size = 0;
  std::function<void(std::uint64_t at, char* to, std::size_t count)> read;
};

/// The fields of a header; empty where their lengths don't add up.
std::optional<std::map<std::string, std::string>> parseFields(const std::string& header);

/// The record that begins at `at`; empty where it does not lie wholly within the source.
std::optional<Record> readRecord(const RecordSource& source, std::uint64_t at);

}  // namespace donex::bag
