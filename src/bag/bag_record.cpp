#include "bag/bag_record.h"

namespace donex::bag {
namespace {

using Length = std::uint32_t;

/// Empty where it does not lie within the source.
std::optional<Length> readLength(const RecordSource& source, std::uint64_t at) {
  Length length = 0;
  if (at > source.size || source.size - at < sizeof(length)) return std::nullopt;
  source.read(at, reinterpret_cast<char*>(&length), sizeof(length));
  const bool fits = length <= source.size - at - sizeof(length);
  return fits ? std::optional(length) : std::nullopt;
}

}  // namespace

std::optional<std::map<std::string, std::string>> parseFields(const std::string& header) {
  std::map<std::string, std::string> fields;
  for (std::size_t at = 0; at < header.size();) {
    if (header.size() - at < sizeof(Length)) return std::nullopt;
    const Length length = *numberIn<Length>(header.substr(at, sizeof(Length)));
    at += sizeof(Length);
    if (length > header.size() - at) return std::nullopt;
    const std::string field = header.substr(at, length);
    const std::size_t equals = field.find('=');
    if (equals == std::string::npos || equals == 0) return std::nullopt;
    fields[field.substr(0, equals)] = field.substr(equals + 1);
    at += length;
  }
  return fields;
}

std::optional<Record> readRecord(const RecordSource& source, std::uint64_t at) {
  const auto header_size = readLength(source, at);
  if (!header_size) return std::nullopt;
  std::string header(*header_size, '\0');
  source.read(at + sizeof(Length), header.data(), header.size());
  const auto fields = parseFields(header);
  const std::uint64_t after = at + sizeof(Length) + *header_size;
  const auto data_size = readLength(source, after);
  if (!fields || !data_size) return std::nullopt;
  return Record{*fields, at, after + sizeof(Length), *data_size};
}

}  // namespace donex::bag
