// A drive in the SemanticKITTI layout: velodyne/NNNNNN.bin, poses.txt, times.txt, labels/NNNNNN.label, calib.txt.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "donex/detector.h"
#include "donex/scan.h"
#include "io/data_error.h"
#include "io/pose.h"

namespace donex {

/// SemanticKITTI labels: the lower 16 bits are the class, the upper 16 the instance.
inline constexpr std::uint32_t kLabelMoving = 251;
inline constexpr std::uint32_t kLabelStatic = 9;
inline std::uint32_t classOfLabel(std::uint32_t label) { return label & 0xFFFFu; }
inline bool isMoving(std::uint32_t label) { return classOfLabel(label) > 250; }
inline bool isScored(std::uint32_t label) { return classOfLabel(label) > 1; }

/// One scan as the layout holds it.
struct SequenceScan {
  double stamp = 0.0;                   ///< [s], whole nanoseconds
  std::vector<Eigen::Vector3f> echoes;  ///< sensor frame [m]; non-finite ones are kept
  std::vector<float> intensities;       ///< one per echo
  Pose odom_from_sensor;
};

/// The sensor itself is the vehicle frame: the layout knows no mounting.
Scan toScan(SequenceScan&& scan);

/// Six digits: 7 -> "000007".
std::string scanName(std::size_t index);

/// Reads a sequence. Everything but the echoes is checked when it is opened.
class SequenceReader {
 public:
  /// Throws DataError with every fault: a missing or empty directory, gaps in the numbering, sizes that are
  /// not a multiple of an echo, lines without a rigid pose or a later time, fewer poses or times than
  /// scans, labels that don't belong to a scan or differ in number from its echoes.
  explicit SequenceReader(std::filesystem::path directory);

  std::size_t size() const { return poses_.size(); }
  const std::filesystem::path& directory() const { return directory_; }
  /// Its directory's own name, however that was spelled.
  std::string name() const;
  double stamp(std::size_t index) const { return stamps_.at(index); }
  /// odom_from_sensor; with calib.txt Tr^-1 * camera pose * Tr.
  const Pose& pose(std::size_t index) const { return poses_.at(index); }
  std::size_t echoes(std::size_t index) const { return echoes_.at(index); }
  bool hasLabels(std::size_t index) const { return has_labels_.at(index) != 0; }
  bool hasLabels() const;

  /// Throws DataError when the file has changed or cannot be read.
  SequenceScan scan(std::size_t index) const;
  std::vector<std::uint32_t> labels(std::size_t index) const;

  /// What was assumed, one sentence each: no times.txt (10 Hz then), more poses or times than scans.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  void readClouds(Faults& faults);
  void readPoses(Faults& faults);
  void readTimes(Faults& faults);
  void addTime(const std::string& line, const std::string& where, Faults& faults);
  void checkLabels(Faults& faults);

  std::filesystem::path directory_;
  std::vector<std::size_t> echoes_;
  std::vector<Pose> poses_;
  std::vector<double> stamps_;
  std::vector<std::uint8_t> has_labels_;
  std::vector<std::string> notes_;
};

/// Writes a sequence, scan after scan. poses.txt holds the sensor's own poses: no calib.txt.
class SequenceWriter {
 public:
  /// Creates the directories. Throws DataError when nothing can be written or parts of a sequence are there already, a
  /// calib.txt included; with `overwrite` those go, and what else lies beside them stays.
  explicit SequenceWriter(std::filesystem::path directory, bool overwrite = false);

  /// Throws DataError when the stamp is not later than the last or a file cannot be written,
  /// std::invalid_argument when intensities or labels are not one per echo.
  void add(const SequenceScan& scan);
  void add(const SequenceScan& scan, const std::vector<std::uint32_t>& labels);

  std::size_t size() const { return size_; }

 private:
  std::filesystem::path directory_;
  std::ofstream poses_;
  std::ofstream times_;
  std::size_t size_ = 0;
  double last_stamp_ = 0.0;
};

/// More echoes than any scan has: a larger file is not a scan.
constexpr std::size_t kMostEchoes = 100000000;

/// kLabelMoving where dynamic, kLabelStatic elsewhere.
std::vector<std::uint32_t> asSemanticKitti(const EchoLabels& labels);

/// A label file by itself; throw DataError. Never half a file is written.
std::vector<std::uint32_t> readLabels(const std::filesystem::path& file);
void writeLabels(const std::filesystem::path& file, const std::vector<std::uint32_t>& labels);

}  // namespace donex
