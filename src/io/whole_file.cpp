#include "io/whole_file.h"

#include <fmt/format.h>
#include <unistd.h>

namespace donex {
namespace fs = std::filesystem;

WholeFile::WholeFile(fs::path file)
    : file_(std::move(file)),
      temporary_(fmt::format("{}.{}.part", file_.string(), getpid())),
      stream_(temporary_, std::ios::binary) {}

WholeFile::~WholeFile() {
  std::error_code ignored;  // after commit() there is no such file
  fs::remove(temporary_, ignored);
}

void WholeFile::commit() {
  stream_.close();
  std::error_code error;
  if (stream_) fs::rename(temporary_, file_, error);
  if (!stream_ || error) throw DataError(file_.string() + ": cannot be written");
}

void writeWhole(const fs::path& file, const std::string& bytes) {
  WholeFile whole(file);
  whole.stream() << bytes;
  whole.commit();
}

void createDirectory(const fs::path& directory) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) throw DataError(fmt::format("{}: cannot be created: {}", directory.string(), error.message()));
}

}  // namespace donex
