#include "io/outputs.h"

#include <algorithm>

#include <sys/stat.h>

namespace donex {
namespace fs = std::filesystem;

bool Outputs::identify(const fs::path& file, Identity& identity) {
  struct stat found {};
  if (stat(file.c_str(), &found) != 0) return false;
  identity = {found.st_dev, found.st_ino};
  return true;
}

void Outputs::addInput(const fs::path& file) {
  Identity identity;
  if (identify(file, identity)) inputs_.insert(identity);
}

void Outputs::addSequence(const fs::path& directory) {
  addInput(directory);
  for (const char* name : {"poses.txt", "times.txt", "calib.txt"}) addInput(directory / name);
  for (const char* name : {"velodyne", "labels"}) {
    addInput(directory / name);
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(directory / name, ignored)) addInput(entry.path());
  }
}

void Outputs::refuseInput(const fs::path& file) const {
  Identity identity;
  const bool is_input = identify(file, identity) && inputs_.count(identity) != 0;
  if (is_input) throw OutputRefused(file.string() + ": is an input, which would be overwritten");
}

void Outputs::require(const fs::path& file) {
  refuseInput(file);
  std::error_code ignored;
  const bool is_new = wanted_.insert(fs::weakly_canonical(file, ignored)).second;
  if (!is_new) throw OutputRefused(file.string() + ": two outputs have this name, one would overwrite the other");
  // A link that leads nowhere is somebody's, too.
  const fs::file_status status = fs::symlink_status(file, ignored);
  if (!fs::exists(status)) return;
  if (fs::is_directory(file, ignored)) throw OutputRefused(file.string() + ": is a directory, must be a file");
  if (!overwrite_) throw OutputRefused(file.string() + ": is there already; --overwrite replaces it");
}

void Outputs::requireIn(const fs::path& directory, const std::function<bool(const std::string& name)>& is_ours) {
  std::error_code ignored;
  std::set<fs::path> found;  // in their order: the same message every time
  for (const auto& entry : fs::directory_iterator(directory, ignored)) {
    if (is_ours(entry.path().filename().string())) found.insert(entry.path());
  }
  for (const fs::path& entry : found) refuseInput(entry);
  if (found.empty() || overwrite_) return;
  throw OutputRefused(found.begin()->string() + ": is there already; --overwrite replaces what has its name");
}

bool isLabelFile(const std::string& name) {
  const std::string ending = ".label";
  const bool ends_so = name.size() > ending.size() && name.substr(name.size() - ending.size()) == ending;
  return ends_so && std::all_of(name.begin(), name.end() - static_cast<std::ptrdiff_t>(ending.size()),
                                [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace donex
