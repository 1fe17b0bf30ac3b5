// Whether an odometry agrees with the scans: both tracks compared, the scans' own found without the odometry's help.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "core/motion/lidar_odometry.h"
#include "core/motion/odometry_cause.h"
#include "core/motion/track_comparison.h"

namespace donex {

enum class Agreement {
  kTooEarly,    ///< not one window yet
  kAgrees,      ///< the newest window
  kDisagrees,   ///< the newest window: labels are harmed
  kCannotTell,  ///< the scans leave their motion open, or lost it, within the newest window
};

/// "not enough scans yet", "agrees", ...
const char* describe(Agreement agreement);

/// What is known after a scan.
struct OdometryFinding {
  Agreement agreement = Agreement::kTooEarly;
  TrackDifference difference;  ///< of the newest window that could be told
  TrackDifference largest;     ///< of all windows, by their harm
  CauseFinding cause;          ///< while they disagree
  double jump = 0.0;           ///< in this scan [m]; 0 for none
  std::size_t windows = 0;     ///< told
  std::size_t harmful = 0;     ///< of these
  std::size_t alarm_scan = 0;  ///< the scan that ends the first of these, counted from 0
  std::size_t scans = 0;
  std::size_t untold = 0;  ///< scans after which it could not be told
  std::size_t jumps = 0;
};

/// One line, fit for a log and a report: "odometry agrees with the scans within 0.05 m and 0.1 degrees over 20 m".
std::string describe(const OdometryFinding& finding);

/// The same of a whole drive: of the windows that disagreed, or of the largest difference.
std::string summaryOf(const OdometryFinding& finding);

/// One scan and what the odometry says of it.
struct ScanInQuestion {
  double stamp = 0.0;  ///< [s] when the scan was measured, on average: the motion in question is that of this moment
  const std::vector<Eigen::Vector3f>& echoes;  ///< as measured, in the sensor frame [m]
  Eigen::Isometry3d base_from_sensor = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d odom_from_base = Eigen::Isometry3d::Identity();
};

/// Bounded in memory and time. Not thread-safe.
class OdometryCheck {
 public:
  struct Options {
    LidarOdometry::Options odometry;
    ComparisonWindow window;
    std::size_t history = 200;      ///< scans that are kept of both tracks
    std::size_t cause_scans = 200;  ///< of these, the newest in which the cause is looked for
    double longest_gap = 0.35;      ///< between scans: after a longer one the scans' own motion is a guess [s]
    double jump = 0.25;             ///< a larger difference in one scan is a jump [m]
    std::size_t cause_period = 10;  ///< scans between two searches for the cause
    double flooded = 0.33;          ///< share of moving echoes above which labels tell nothing of what moves
    bool is_twist = false;          ///< the odometry's poses are integrated velocities
  };

  OdometryCheck() : OdometryCheck(Options()) {}
  explicit OdometryCheck(const Options& options) : options_(options), odometry_(options.odometry) {}

  const OdometryFinding& check(const ScanInQuestion& scan);

  /// Labels of the scan checked last: what moves tells nothing of the ego motion.
  void learn(const std::vector<std::uint8_t>& dynamic);

  const OdometryFinding& finding() const { return finding_; }
  /// The newest scans of both tracks.
  const std::deque<ComparedScan>& scans() const { return scans_; }

  /// The odometry starts anew: what was found of the scans stays.
  void forgetOdometry() { scans_.clear(); }
  void reset();

 private:
  void compare();
  void tellJump();

  Options options_;
  LidarOdometry odometry_;
  std::deque<ComparedScan> scans_;
  std::size_t until_cause_ = 0;
  OdometryFinding finding_;
};

}  // namespace donex
