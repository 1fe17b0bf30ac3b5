// A method, live or not, over a sequence: the scans in their order, as often as the method asks for.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/motion/lidar_odometry.h"
#include "core/motion/odometry_check.h"
#include "core/motion/odometry_jump.h"
#include "core/motion/planar_completion.h"
#include "donex/whole_drive.h"
#include "evaluation/scan_parts.h"
#include "io/sequence.h"

namespace donex {

/// Whose poses a drive is judged with.
enum class DriveOdometry {
  kGiven,  ///< the sequence's
  kLidar,  ///< found from its scans alone
};

class DriveRun {
 public:
  /// Throws std::invalid_argument with every fault of the configuration.
  explicit DriveRun(const Config& config, DriveOdometry odometry = DriveOdometry::kGiven);

  /// Shows the method each scan in so many parts (ScanParts); labels and times are those of whole scans again.
  void cutScansInto(std::size_t parts) { parts_ = ScanParts(parts); }

  /// Takes the labels of a scan; `index` is the sequence's.
  using Sink = std::function<void(std::size_t index, const Scan& scan, const EchoLabels& labels)>;

  /// Shows the first `scans` scans; `progress` is called scans * passes() times. Throws DataError from the reader.
  void run(const SequenceReader& sequence, std::size_t scans, const Sink& sink, const std::function<void()>& progress);

  std::size_t passes() const { return whole_ == nullptr ? 1U : static_cast<std::size_t>(whole_->passes()); }

  /// Wall clock and CPU time of all threads that judging took, a scan, all passes together [s].
  const std::vector<double>& times() const { return times_; }
  const std::vector<double>& cpuTimes() const { return cpu_times_; }

  /// With DriveOdometry::kLidar where each scan was found; else empty.
  const std::vector<TrackedScan>& tracked() const { return tracked_; }
  /// CPU time [s] of finding a scan, or height, roll and pitch of those whose poses never leave their plane.
  const std::vector<double>& odometryTimes() const { return odometry_times_; }

  /// Of the poses given against the scans; null without them.
  const OdometryCheck* check() const { return check_ ? &*check_ : nullptr; }

  /// Scans whose height, roll and pitch were found so.
  std::size_t completed() const { return completed_; }

  /// Jumps of the poses given, at each of which a live method has forgotten its grid.
  std::size_t jumps() const { return jumps_; }

  /// Bytes held by the method's own memory after the last scan.
  std::size_t memoryBytes() const { return detector().memoryBytes(); }

 private:
  Detector& detector() { return whole_ == nullptr ? *live_ : *whole_; }
  const Detector& detector() const { return whole_ == nullptr ? *live_ : *whole_; }
  /// `duration`: time that the scan took [s].
  void judge(const Scan& scan, std::size_t index, double duration);
  void locate(Scan& scan, std::size_t index);
  void learn(std::size_t index);
  void compare(const Scan& scan, const Eigen::Isometry3d& given, std::size_t index);
  void followPoses(const Scan& scan);
  void complete(Scan& scan, std::size_t index);

  std::unique_ptr<Detector> live_;
  std::unique_ptr<WholeDriveDetector> whole_;
  EchoLabels labels_, labels_of_part_;
  ScanParts parts_{1};
  std::optional<LidarOdometry> odometry_;
  std::optional<OdometryCheck> check_;
  OdometryJump jump_;
  std::optional<PlanarCompletion> completion_;
  std::size_t checked_ = 0, jumps_ = 0, completed_ = 0;  // scans
  std::vector<TrackedScan> tracked_;
  std::vector<Eigen::Isometry3d> completed_poses_;
  std::vector<double> odometry_times_;
  std::vector<double> times_, cpu_times_;
};

}  // namespace donex
