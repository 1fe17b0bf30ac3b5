// What a program may write: nothing that is there already, unless it is told to, and never what it reads.
#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

namespace donex {

/// An output that exists, or that is an input, or that is wanted twice. Nothing has been written.
class OutputRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Checked before the first byte is written.
class Outputs {
 public:
  explicit Outputs(bool overwrite) : overwrite_(overwrite) {}

  /// Never an output, by whatever path, symbolic or hard link. Passes where there is no such file: whoever opens it
  /// says so.
  void addInput(const std::filesystem::path& file);
  /// The files of a sequence and the folders they are in; other folders may lie beside them.
  void addSequence(const std::filesystem::path& directory);

  /// Throws OutputRefused unless `file` may be written.
  void require(const std::filesystem::path& file);
  /// The same for every entry of `directory` that `is_ours` (by its name): what would be written over, or be mixed
  /// with what is written.
  void requireIn(const std::filesystem::path& directory, const std::function<bool(const std::string& name)>& is_ours);

 private:
  using Identity = std::pair<std::uintmax_t, std::uintmax_t>;  // device and number of a file

  static bool identify(const std::filesystem::path& file, Identity& identity);
  void refuseInput(const std::filesystem::path& file) const;

  bool overwrite_;
  std::set<Identity> inputs_;
  std::set<std::filesystem::path> wanted_;
};

/// "000007.label": the labels of a scan.
bool isLabelFile(const std::string& name);

}  // namespace donex
