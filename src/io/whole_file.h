// Files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "io/data_error.h"

namespace donex {

/// Written under a temporary name beside its own, that of this process: two runs don't write into each other.
class WholeFile {
 public:
  explicit WholeFile(std::filesystem::path file);

  /// Without commit() nothing remains.
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  /// Binary. Errors are reported by commit().
  std::ofstream& stream() { return stream_; }

  /// Gives it its own name, replacing a file of that name. Throws DataError when it could not be written to the end.
  void commit();

 private:
  std::filesystem::path file_;
  std::filesystem::path temporary_;
  std::ofstream stream_;
};

/// All of it at once. Throws DataError.
void writeWhole(const std::filesystem::path& file, const std::string& bytes);

/// With those above it, unless they are there. Throws DataError.
void createDirectory(const std::filesystem::path& directory);

}  // namespace donex
