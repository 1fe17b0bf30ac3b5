// The check of odometry beside the labelling: labelled scans in, what it found out.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <sensor_msgs/PointCloud2.h>

#include "core/motion/odometry_check.h"
#include "ros/pipeline.h"

namespace donex {

/// Whether the ego motion of this source is somebody else's word, which can be checked.
bool isChecked(const MotionConfig& config, OdometrySource source);

/// Scans are registered against those of the same sensor: of several on a topic one is checked.
class OneSensor {
 public:
  bool isIt(const std::string& frame);

 private:
  static constexpr int kGone = 100;  // clouds of others since its last one: another is taken
  std::string frame_;
  int others_ = 0;  // clouds in a row
};

/// OdometryCheck on labelled scans; the echoes are read from the cloud once more, as they were measured.
class LabeledScanCheck {
 public:
  /// With `keep_all` both tracks are kept whole: a few hundred bytes a scan.
  explicit LabeledScanCheck(const MotionConfig& config, bool keep_all = false);

  /// What of a labelled scan the check needs, for as long as it likes.
  struct Question {
    sensor_msgs::PointCloud2ConstPtr cloud;
    CloudLayout layout;
    ScanMotion::Sample moment;
    Eigen::Isometry3d base_from_sensor;
    std::optional<Eigen::Isometry3d> sensor_from_cloud;
    std::size_t track = 0;
    std::vector<std::uint8_t> dynamic;
  };
  static Question questionOf(const LabeledScan& scan);

  const OdometryFinding& check(const Question& question);
  const OdometryFinding& finding() const { return check_.finding(); }
  const OdometryCheck& details() const { return check_; }

 private:
  OdometryCheck check_;
  std::optional<std::size_t> track_;
  std::vector<Eigen::Vector3f> echoes_;
};

/// The same on a thread of its own. Where that is late, the newest scan alone waits.
class OdometryMonitor {
 public:
  /// `tell` is called on the thread, after each scan.
  using Tell = std::function<void(const OdometryFinding& finding)>;

  OdometryMonitor(const MotionConfig& config, Tell tell);
  ~OdometryMonitor();
  OdometryMonitor(const OdometryMonitor&) = delete;
  OdometryMonitor& operator=(const OdometryMonitor&) = delete;

  void add(const LabeledScan& scan);

 private:
  void run();

  OneSensor sensor_;
  LabeledScanCheck check_;
  Tell tell_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<LabeledScanCheck::Question> waiting_;
  bool ends_ = false;
  std::thread thread_;  // last: it uses the others
};

}  // namespace donex
