#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "io/sequence.h"
#include "io/text_file.h"

namespace donex {
namespace fs = std::filesystem;
namespace {

constexpr std::uintmax_t kBytesPerEcho = 4 * sizeof(float);
constexpr double kAssumedPeriod = 0.1;  // [s]

/// Numbered files NNNNNN.<extension> of a directory, sorted; any other name with this extension is a fault.
std::vector<std::size_t> numberedFiles(const fs::path& directory, const std::string& extension, Faults& faults) {
  std::vector<std::size_t> numbers;
  for (const auto& entry : fs::directory_iterator(directory)) {
    if (entry.path().extension() != extension) continue;
    const std::string stem = entry.path().stem().string();
    const bool six_digits = stem.size() == 6 && stem.find_first_not_of("0123456789") == std::string::npos;
    if (six_digits) {
      numbers.push_back(std::stoul(stem));
    } else {
      faults.add(entry.path().string() + ": the name is not six digits");
    }
  }
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

/// Numbers must run 0, 1, 2, ...
void checkGaps(const fs::path& directory, const std::vector<std::size_t>& numbers, Faults& faults) {
  std::size_t expected = 0;
  for (const std::size_t number : numbers) {
    if (number == expected + 1) {
      faults.add(fmt::format("{}: {}.bin is missing", directory.string(), scanName(expected)));
    } else if (number > expected) {
      faults.add(fmt::format("{}: {}.bin to {}.bin are missing", directory.string(), scanName(expected),
                             scanName(number - 1)));
    }
    expected = number + 1;
  }
}

/// Bytes in units of `unit`; adds a fault where they don't divide or the file is too large for a scan.
std::size_t countUnits(const fs::path& file, std::uintmax_t unit, const char* unit_name, Faults& faults) {
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(file, error);
  if (error) {
    faults.add(fmt::format("{}: {}", file.string(), error.message()));
    return 0;
  }
  if (bytes % unit != 0) {
    faults.add(fmt::format("{}: {} bytes, no multiple of {} ({})", file.string(), bytes, unit, unit_name));
  }
  if (bytes / unit > kMostEchoes) {
    faults.add(fmt::format("{}: {} bytes, of more than {} echoes", file.string(), bytes, kMostEchoes));
  }
  return static_cast<std::size_t>(bytes / unit);
}

/// As ros::Time holds it, so that the same stamp comes out of a bag.
double wholeNanoseconds(double stamp) {
  const double seconds = std::floor(stamp);
  const double nanoseconds = std::round((stamp - seconds) * 1e9);
  return nanoseconds < 1e9 ? seconds + 1e-9 * nanoseconds : seconds + 1.0;
}

/// Tr of calib.txt (camera from LiDAR); the identity's Pose only where there is no calib.txt at all.
std::optional<Pose> readCalibration(const fs::path& file, Faults& faults) {
  const auto lines = readLines(file, faults);
  if (!lines) return std::nullopt;
  for (std::size_t i = 0; i < lines->size(); ++i) {
    if ((*lines)[i].rfind("Tr:", 0) != 0) continue;
    const auto matrix = parsePose((*lines)[i].substr(3), place(file, i + 1), faults);
    return matrix ? std::optional<Pose>(poseFromMatrix(*matrix)) : std::nullopt;
  }
  faults.add(file.string() + ": has no line 'Tr:' (the LiDAR's place in the camera's frame)");
  return std::nullopt;
}

Pose lidarPose(const Pose& camera, const Pose& camera_from_lidar) {
  const Eigen::Isometry3d tr = camera_from_lidar.isometry();
  return Pose::fromIsometry(tr.inverse() * camera.isometry() * tr);
}

/// One value per scan: fewer is a fault, more is worth a note.
void compareCount(const fs::path& file, std::size_t lines, std::size_t scans, Faults& faults,
                  std::vector<std::string>& notes) {
  const std::string counts = fmt::format("{}: {} lines for {} scans", file.string(), lines, scans);
  if (lines < scans) faults.add(counts);
  if (lines > scans) notes.push_back(counts + "; the rest is left out");
}

}  // namespace

std::string scanName(std::size_t index) { return fmt::format("{:06d}", index); }

Scan toScan(SequenceScan&& scan) {
  Scan result;
  result.stamp = scan.stamp;
  result.echoes = std::move(scan.echoes);
  result.odom_from_base = scan.odom_from_sensor.isometry();
  return result;
}

SequenceReader::SequenceReader(fs::path directory) : directory_(std::move(directory)) {
  if (!fs::is_directory(directory_)) throw DataError(directory_.string() + ": is not a directory");
  Faults faults;
  readClouds(faults);
  faults.throwIfAny();  // the other files are counted against the scans
  readPoses(faults);
  readTimes(faults);
  checkLabels(faults);
  faults.throwIfAny();
}

void SequenceReader::readClouds(Faults& faults) {
  const fs::path folder = directory_ / "velodyne";
  if (!fs::is_directory(folder)) throw DataError(folder.string() + ": is missing (the scans NNNNNN.bin)");
  const auto numbers = numberedFiles(folder, ".bin", faults);
  checkGaps(folder, numbers, faults);
  for (const std::size_t number : numbers) {
    const fs::path file = folder / (scanName(number) + ".bin");
    echoes_.push_back(countUnits(file, kBytesPerEcho, "x, y, z, intensity as float32", faults));
  }
  if (numbers.empty()) faults.add(folder.string() + ": holds no scan NNNNNN.bin");
}

void SequenceReader::readPoses(Faults& faults) {
  const fs::path file = directory_ / "poses.txt";
  const fs::path calibration = directory_ / "calib.txt";
  const bool are_camera_poses = fs::exists(calibration);
  const auto camera_from_lidar = are_camera_poses ? readCalibration(calibration, faults) : std::nullopt;
  const auto lines = readLines(file, faults);
  if (!lines) return;
  compareCount(file, lines->size(), echoes_.size(), faults, notes_);
  for (std::size_t i = 0; i < std::min(lines->size(), echoes_.size()); ++i) {
    const auto matrix = parsePose((*lines)[i], place(file, i + 1), faults);
    if (!matrix) continue;
    const Pose pose = poseFromMatrix(*matrix);
    poses_.push_back(camera_from_lidar ? lidarPose(pose, *camera_from_lidar) : pose);
  }
}

void SequenceReader::readTimes(Faults& faults) {
  const fs::path file = directory_ / "times.txt";
  if (!fs::exists(file)) {
    notes_.push_back(file.string() + ": is missing, 10 scans a second are assumed");
    for (std::size_t i = 0; i < echoes_.size(); ++i) {
      stamps_.push_back(wholeNanoseconds(kAssumedPeriod * static_cast<double>(i)));
    }
    return;
  }
  const auto lines = readLines(file, faults);
  if (!lines) return;
  compareCount(file, lines->size(), echoes_.size(), faults, notes_);
  for (std::size_t i = 0; i < std::min(lines->size(), echoes_.size()); ++i) {
    addTime((*lines)[i], place(file, i + 1), faults);
  }
}

void SequenceReader::addTime(const std::string& line, const std::string& where, Faults& faults) {
  const auto numbers = parseNumbers(line, 1, where, faults);
  if (!numbers) return;
  const double stamp = numbers->front();
  if (!std::isfinite(stamp)) {
    faults.add(where + ": the time is not finite");
    return;
  }
  const bool later = stamps_.empty() || wholeNanoseconds(stamp) > stamps_.back();
  if (!later) faults.add(fmt::format("{}: the time {} is not later than the one before", where, line));
  stamps_.push_back(wholeNanoseconds(stamp));
}

void SequenceReader::checkLabels(Faults& faults) {
  has_labels_.assign(echoes_.size(), 0);
  const fs::path folder = directory_ / "labels";
  if (!fs::is_directory(folder)) return;
  for (const std::size_t number : numberedFiles(folder, ".label", faults)) {
    const fs::path file = folder / (scanName(number) + ".label");
    const std::size_t labels = countUnits(file, sizeof(std::uint32_t), "a label", faults);
    if (number >= echoes_.size()) {
      faults.add(fmt::format("{}: there is no scan {}", file.string(), scanName(number)));
    } else if (labels != echoes_[number]) {
      faults.add(fmt::format("{}: {} labels for {} echoes", file.string(), labels, echoes_[number]));
    } else {
      has_labels_[number] = 1;
    }
  }
}

std::string SequenceReader::name() const {
  return (fs::absolute(directory_) / "").lexically_normal().parent_path().filename().string();
}

bool SequenceReader::hasLabels() const {
  return std::any_of(has_labels_.begin(), has_labels_.end(), [](std::uint8_t has) { return has != 0; });
}

SequenceScan SequenceReader::scan(std::size_t index) const {
  const fs::path file = directory_ / "velodyne" / (scanName(index) + ".bin");
  std::vector<Eigen::Vector4f> rows(echoes(index));
  std::ifstream stream(file, std::ios::binary);
  stream.read(reinterpret_cast<char*>(rows.data()), static_cast<std::streamsize>(rows.size() * kBytesPerEcho));
  if (!stream) throw DataError(file.string() + ": cannot be read");
  SequenceScan scan;
  scan.stamp = stamp(index);
  scan.odom_from_sensor = pose(index);
  scan.echoes.reserve(rows.size());
  scan.intensities.reserve(rows.size());
  for (const Eigen::Vector4f& row : rows) {
    scan.echoes.emplace_back(row.head<3>());
    scan.intensities.push_back(row.w());
  }
  return scan;
}

std::vector<std::uint32_t> SequenceReader::labels(std::size_t index) const {
  if (!hasLabels(index)) throw DataError(directory_.string() + ": scan " + scanName(index) + " has no labels");
  const fs::path file = directory_ / "labels" / (scanName(index) + ".label");
  auto labels = readLabels(file);
  if (labels.size() != echoes(index)) throw DataError(file.string() + ": has changed while it was read");
  return labels;
}

}  // namespace donex
