#include <fstream>

#include "io/sequence.h"
#include "io/whole_file.h"

namespace donex {
namespace fs = std::filesystem;

std::vector<std::uint32_t> asSemanticKitti(const EchoLabels& labels) {
  std::vector<std::uint32_t> result(labels.dynamic.size(), kLabelStatic);
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (labels.dynamic[i] != 0) result[i] = kLabelMoving;
  }
  return result;
}

std::vector<std::uint32_t> readLabels(const fs::path& file) {
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(file, error);
  if (error) throw DataError(file.string() + ": " + error.message());
  if (bytes % sizeof(std::uint32_t) != 0) {
    throw DataError(file.string() + ": " + std::to_string(bytes) + " bytes, no multiple of 4 (a label)");
  }
  if (bytes / sizeof(std::uint32_t) > kMostEchoes) {
    throw DataError(file.string() + ": " + std::to_string(bytes) + " bytes, of more than " +
                    std::to_string(kMostEchoes) + " echoes");
  }
  std::vector<std::uint32_t> labels(bytes / sizeof(std::uint32_t));
  std::ifstream stream(file, std::ios::binary);
  stream.read(reinterpret_cast<char*>(labels.data()), static_cast<std::streamsize>(bytes));
  if (!stream) throw DataError(file.string() + ": cannot be read");
  return labels;
}

void writeLabels(const fs::path& file, const std::vector<std::uint32_t>& labels) {
  WholeFile whole(file);
  whole.stream().write(reinterpret_cast<const char*>(labels.data()),
                       static_cast<std::streamsize>(labels.size() * sizeof(std::uint32_t)));
  whole.commit();
}

}  // namespace donex
