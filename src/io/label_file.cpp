#include <fstream>

#include "donex/io/sequence.h"

namespace donex {
namespace fs = std::filesystem;

std::vector<std::uint32_t> readLabels(const fs::path& file) {
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(file, error);
  if (error) throw DataError(file.string() + ": " + error.message());
  if (bytes % sizeof(std::uint32_t) != 0) {
    throw DataError(file.string() + ": " + std::to_string(bytes) + " bytes, no multiple of 4 (a label)");
  }
  std::vector<std::uint32_t> labels(bytes / sizeof(std::uint32_t));
  std::ifstream stream(file, std::ios::binary);
  stream.read(reinterpret_cast<char*>(labels.data()), static_cast<std::streamsize>(bytes));
  if (!stream) throw DataError(file.string() + ": cannot be read");
  return labels;
}

void writeLabels(const fs::path& file, const std::vector<std::uint32_t>& labels) {
  const fs::path temporary = file.string() + ".part";
  std::ofstream stream(temporary, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(labels.data()),
               static_cast<std::streamsize>(labels.size() * sizeof(std::uint32_t)));
  stream.close();
  std::error_code error;
  if (stream) fs::rename(temporary, file, error);
  if (stream && !error) return;
  std::error_code ignored;  // the first error is the one to tell
  fs::remove(temporary, ignored);
  throw DataError(file.string() + ": cannot be written");
}

}  // namespace donex
