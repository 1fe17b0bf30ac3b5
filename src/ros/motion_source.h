// Where vehicle and sensor were during a scan: odometry messages or tf, and the mounting from tf.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <nav_msgs/Odometry.h>
#include <ros/time.h>
#include <tf2/buffer_core.h>

#include "core/motion/pose_and_twist.h"
#include "donex/config.h"
#include "donex/motion/ego_motion.h"
#include "ros/drop_reason.h"
#include "ros/scan_odometry.h"

namespace donex {

/// What became of an odometry message.
struct OdometryVerdict {
  enum class Kind {
    kUsed,
    kRefused,      ///< see refusal
    kTimeRanBack,  ///< not used: much older than the newest
    kNewTrack,     ///< used, but poses before and after cannot be compared: forget the grid
  };
  Kind kind = Kind::kUsed;
  OdometryRefusal refusal = OdometryRefusal::kNonFinite;
  std::string text;  ///< of anything but kUsed
};

/// The moments of a scan that have to be covered.
struct ScanTimes {
  ros::Time stamp;
  double first = 0.0, last = 0.0;                 ///< echoes' times after the stamp [s]; both zero without de-skewing
  const std::vector<float>* of_echoes = nullptr;  ///< each one's; null without

  bool spanTime() const { return last > first; }
};

/// The motion of one scan.
struct ScanMotion {
  Eigen::Isometry3d base_from_sensor = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d odom_from_base = Eigen::Isometry3d::Identity();  ///< at the stamp
  std::string odom_frame, base_frame;
  /// Covers the scan's times, to de-skew by; null where there is nothing to undo. Valid until the source's next call.
  const EgoMotion* track = nullptr;
  /// The vehicle in the middle of the scan, which tells of all its echoes.
  struct Sample {
    double stamp = 0.0;  ///< [s]
    Eigen::Isometry3d odom_from_base = Eigen::Isometry3d::Identity();
  };
  Sample midway;
  /// Where the cloud is told in another frame than its sensor's.
  std::optional<Eigen::Isometry3d> sensor_from_cloud;
  std::size_t track_number = 0;  ///< poses of another one cannot be compared
  /// Where the motion was found in the clouds: how well, and the velocity since the scan before.
  std::optional<TrackedScan> tracked;
  Twist twist;
};

/// Why there is no motion (yet).
struct MotionMissing {
  DropReason reason;
  std::string text;
  bool may_come;  ///< waiting can help
};

using MotionAnswer = std::variant<ScanMotion, MotionMissing>;

/// Knows no clock and no master: odometry is handed in, `tf` is filled by somebody else.
class MotionSource {
 public:
  /// `tf` must outlive the source; it is not asked with OdometrySource::kNone.
  MotionSource(const MotionConfig& config, const tf2::BufferCore& tf);

  OdometryVerdict add(const nav_msgs::Odometry& odometry);

  /// The motion of a scan measured in `sensor_frame`. With `settle` the newest odometry may be extrapolated
  /// as far as configured; without, it has to cover the scan: what comes does not depend on when one asks.
  /// `echoes` are the scan's, as measured, in the sensor frame [m]; with OdometrySource::kLidar an answer other than
  /// "may come" is given once a scan, in the order of the stamps.
  MotionAnswer during(const ScanTimes& times, const std::string& sensor_frame, bool settle,
                      const std::vector<Eigen::Vector3f>& echoes);

  /// The labels of the scan that was last asked for: what moves tells nothing of the ego motion.
  void learn(const std::vector<std::uint8_t>& dynamic);

  /// Where the motion comes from; kAuto until that is known.
  OdometrySource source() const { return source_; }
  /// In words, once kAuto has found what there is; else empty.
  const std::string& choice() const { return choice_; }
  /// Whether an odometry message is of use.
  bool wantsOdometry() const;

  void reset();
  /// What was found in the clouds so far was found of distorted ones: a new track begins.
  void forgetClouds() { scan_odometry_.reset(); }

 private:
  MotionAnswer fromOdometry(const ScanTimes& times, const std::string& sensor_frame, bool settle) const;
  std::optional<MotionMissing> choose(const ScanTimes& times, bool settle);
  MotionAnswer fromScans(const ScanTimes& times, const std::string& sensor_frame, bool settle,
                         const std::vector<Eigen::Vector3f>& echoes);
  std::optional<MotionMissing> mount(const ScanTimes& times, const std::string& sensor_frame, bool settle);
  MotionAnswer fromTf(const ScanTimes& times, const std::string& sensor_frame);
  std::optional<MotionMissing> trackFromTf(const ScanTimes& times);
  void addMidway(const ScanTimes& times, const EgoMotion& track, ScanMotion& motion) const;
  OdometryVerdict standingStill(const OdometrySample& sample) const;
  OdometryVerdict addSample(const nav_msgs::Odometry& odometry, const OdometrySample& sample);
  std::variant<Eigen::Isometry3d, MotionMissing> lookup(const std::string& target, const std::string& source,
                                                        const ros::Time& stamp) const;
  /// The vehicle's frame and the one that it moves in.
  struct Frames {
    std::string base, odom;
    bool operator==(const Frames& other) const { return base == other.base && odom == other.odom; }
  };
  Frames framesOf(const nav_msgs::Odometry& odometry) const;
  int configured(const Frames& frames) const;
  bool isSecondSource(const Frames& frames, double stamp) const;
  bool adoptFrames(const nav_msgs::Odometry& odometry);

  MotionConfig config_;
  OdometrySource source_;
  std::string choice_;
  const tf2::BufferCore& tf_;
  EgoMotion odometry_;
  PoseAndTwist pose_and_twist_;
  std::size_t track_number_ = 0;
  EgoMotion tf_track_;  // of one scan
  ScanOdometry scan_odometry_;
  std::map<std::string, Eigen::Isometry3d> mountings_;  // of sensors by their frames, with kLidar; they stay
  std::string mounted_frame_;                           // the vehicle's, with kLidar
  Frames frames_;                                       // of the odometry in use; empty before the first
};

}  // namespace donex
