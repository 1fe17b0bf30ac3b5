#include <stdexcept>

#include <fmt/format.h>

#include "io/sequence.h"
#include "io/whole_file.h"

namespace donex {
namespace fs = std::filesystem;
namespace {

void writeCloud(const fs::path& file, const SequenceScan& scan) {
  std::vector<Eigen::Vector4f> rows(scan.echoes.size());
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] << scan.echoes[i], scan.intensities[i];
  std::ofstream stream(file, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(rows.data()),
               static_cast<std::streamsize>(rows.size() * sizeof(Eigen::Vector4f)));
  stream.close();
  if (!stream) throw DataError(file.string() + ": cannot be written");
}

/// What is there of another sequence would be overwritten, or taken for a part of the new one.
void requireNoSequence(const fs::path& directory) {
  for (const char* name : {"velodyne", "labels"}) {
    const fs::path folder = directory / name;
    const bool is_taken = fs::is_directory(folder) && !fs::is_empty(folder);
    if (is_taken) throw DataError(folder.string() + ": is not empty, would mix two sequences; --overwrite replaces it");
  }
  for (const char* name : {"poses.txt", "times.txt", "calib.txt"}) {
    const fs::path file = directory / name;
    if (fs::exists(file))
      throw DataError(file.string() + ": is there already, belongs to another sequence; --overwrite replaces it");
  }
}

/// Scans and their labels have names of digits: nothing else is taken away.
void removeSequence(const fs::path& directory) {
  for (const char* name : {"velodyne", "labels"}) {
    std::error_code ignored;
    std::vector<fs::path> scans;
    for (const auto& entry : fs::directory_iterator(directory / name, ignored)) {
      const std::string stem = entry.path().stem().string();
      if (stem.find_first_not_of("0123456789") == std::string::npos) scans.push_back(entry.path());
    }
    for (const fs::path& scan : scans) fs::remove(scan);
  }
  for (const char* name : {"poses.txt", "times.txt", "calib.txt"}) fs::remove(directory / name);
}

}  // namespace

SequenceWriter::SequenceWriter(fs::path directory, bool overwrite) : directory_(std::move(directory)) {
  if (overwrite) removeSequence(directory_);
  requireNoSequence(directory_);
  createDirectory(directory_ / "velodyne");
  poses_.open(directory_ / "poses.txt");
  times_.open(directory_ / "times.txt");
  if (!poses_ || !times_) throw DataError(directory_.string() + ": cannot be written");
}

void SequenceWriter::add(const SequenceScan& scan) {
  if (scan.intensities.size() != scan.echoes.size()) {
    throw std::invalid_argument("as many intensities as echoes are needed");
  }
  const bool later = size_ == 0 || scan.stamp > last_stamp_;
  if (!later) {
    throw DataError(fmt::format("scan {}: its time {:.9f} s is not later than the last", size_, scan.stamp));
  }
  writeCloud(directory_ / "velodyne" / (scanName(size_) + ".bin"), scan);
  // Flushed at once: what stands on disk is a whole sequence after every scan.
  poses_ << poseLine(scan.odom_from_sensor) << std::flush;
  times_ << fmt::format("{:.9f}\n", scan.stamp) << std::flush;
  if (!poses_ || !times_) throw DataError(directory_.string() + ": poses.txt or times.txt cannot be written");
  last_stamp_ = scan.stamp;
  ++size_;
}

void SequenceWriter::add(const SequenceScan& scan, const std::vector<std::uint32_t>& labels) {
  if (labels.size() != scan.echoes.size()) throw std::invalid_argument("as many labels as echoes are needed");
  createDirectory(directory_ / "labels");
  const std::string name = scanName(size_) + ".label";
  add(scan);
  writeLabels(directory_ / "labels" / name, labels);
}

}  // namespace donex
