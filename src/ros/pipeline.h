// From messages to labels: what the node and donex_bag share, so that both give the same labels, echo by echo.
#pragma once

#include <array>
#include <chrono>
#include <deque>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include <nav_msgs/Odometry.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2/buffer_core.h>

#include "core/sight/second_returns.h"
#include "donex/detector.h"
#include "ros/cloud_order.h"
#include "ros/cloud_placer.h"
#include "ros/cloud_remarks.h"
#include "ros/conversions.h"
#include "ros/drop_reason.h"
#include "ros/echo_clock.h"
#include "ros/flood_watch.h"
#include "ros/given_odometry.h"
#include "ros/motion_source.h"
#include "ros/origin_watch.h"

namespace donex {

/// A scan that has been judged; the references are valid during the call that hands it out.
struct LabeledScan {
  sensor_msgs::PointCloud2ConstPtr cloud;  ///< as it came
  const CloudLayout& layout;
  const Scan& scan;
  const EchoLabels& labels;
  const Detector& detector;
  const std::string& odom_frame;
  /// From the world as the scan and the detector tell it: the identity, unless the odometry was completed.
  const Eigen::Isometry3d& odom_from_world;
  const ScanMotion& motion;
  double last_echo;  ///< when it was measured: its own time, where it has any, else the stamp [s]
  std::chrono::steady_clock::time_point received;
  double processing_time;  ///< parsing, de-skewing and judging [s]
};

/// What the pipeline tells its owner; every function must be set.
struct PipelineEvents {
  std::function<void(const LabeledScan&)> labeled;
  std::function<void(DropReason, const std::string& text)> dropped;       ///< once per dropped cloud
  std::function<void(OdometryRefusal, const std::string& text)> refused;  ///< once per refused odometry
  std::function<void(const std::string& text)> forgotten;                 ///< the grid is empty again, and why
  std::function<void(const std::string& text)> strange_times;             ///< once per cloud that cannot be de-skewed
  /// What is strange about a cloud that is labelled all the same: each kind once; may be left empty.
  std::function<void(CloudRemark, const std::string& text)> remarked = nullptr;
  /// Where the ego motion comes from, once odometry_source auto knows; may be left empty.
  std::function<void(const std::string& text)> motion_chosen = nullptr;
  /// Once, where the clouds look as if their sensor were elsewhere; may be left empty.
  std::function<void(const std::string& text)> strange_origin = nullptr;
  /// A large share of what stands has become dynamic at once, and what was checked; may be left empty.
  std::function<void(const std::string& text)> flooded = nullptr;
  /// The unit of the echoes' times, where it is not the usual one of their field; may be left empty.
  std::function<void(const std::string& text)> unit_found = nullptr;
  /// The same of what these times count from, told by the scans; may be left empty.
  std::function<void(const std::string& text)> reading_found = nullptr;
  /// What the sensor is like, as its first scans show it; may be left empty.
  std::function<void(const std::string& text)> sensor_measured = nullptr;
  /// The odometry never leaves its plane, and height, roll and pitch come from the scans; may be left empty.
  std::function<void(const std::string& text)> odometry_completed = nullptr;
  /// There is nothing to de-skew the clouds by, and why; when that changes; may be left empty.
  std::function<void(const std::string& text)> not_deskewed = nullptr;
};

struct PipelineCounts {
  std::size_t clouds_in = 0, clouds_labeled = 0;
  std::size_t odometry_in = 0;
  DropCounts dropped;
  OdometryRefusalCounts refused;
  std::size_t floods = 0;      ///< alarms: what stands became dynamic at once
  std::size_t jumps = 0;       ///< of the odometry; each forgets the grid
  std::size_t completed = 0;   ///< labelled with height, roll and pitch from the scans
  std::size_t degenerate = 0;  ///< labelled with an ego motion from the clouds that they leave open in part
};

/// Pairs clouds with motion by time, never by order of arrival, and has them judged in the order of their
/// stamps. Every cloud is labelled or dropped for a reason, exactly once. Knows no clock: `now` [s] is any clock
/// that runs as the messages arrive (ROS time; the record time in a bag). Not thread-safe.
class Pipeline {
 public:
  /// Throws std::invalid_argument with every fault of the configuration. `tf` must outlive the pipeline.
  Pipeline(const Config& config, const tf2::BufferCore& tf, PipelineEvents events);

  /// The same with a detector that outlives it: whole drives are shown to one detector several times.
  Pipeline(const Config& config, const tf2::BufferCore& tf, PipelineEvents events, std::shared_ptr<Detector> detector);

  void addCloud(const sensor_msgs::PointCloud2ConstPtr& cloud, double now);
  /// A message that should have been a cloud, and why it is none: counted as one that came and was dropped.
  void refuseCloud(const std::string& why);
  void addOdometry(const nav_msgs::Odometry& odometry);

  /// Labels or drops the oldest waiting cloud when its time has come; false when there was nothing to do.
  bool step(double now);

  /// Nothing more will come: every waiting cloud is labelled or dropped now.
  void finish();

  /// Forgets the grid; odometry and waiting clouds stay.
  void reset();

  /// Takes the new values between two scans; the grid is built anew (empty) when one of its parameters changed.
  /// Throws std::invalid_argument for a faulty configuration, and then stays as it was. Parameters of the
  /// motion are fixed at construction.
  void configure(const Config& config);

  /// Whether somebody wants to see the cells of the coming scans (Detector::memoryCells).
  void watchCells(bool watched);

  std::size_t waiting() const { return waiting_.size(); }
  const PipelineCounts& counts() const { return counts_; }
  const Detector& detector() const { return *detector_; }
  /// On the newest labelled cloud.
  const CloudRemarks& remarks() const { return remarks_; }
  const MotionSource& motion() const { return motion_; }
  /// "times in 'time' ...", or "nothing: " and why.
  std::string deskewedBy() const { return clocks_.deskewedBy(); }

 private:
  struct WaitingCloud {
    sensor_msgs::PointCloud2ConstPtr cloud;
    CloudLayout layout;
    std::size_t number = 0;  // in the order of arrival, from 1 on
    double arrival = 0.0;
    std::chrono::steady_clock::time_point received;
  };

  void parse(const WaitingCloud& waiting);
  EchoClock& clockOf(const WaitingCloud& waiting) { return clocks_.of(waiting.cloud->header.frame_id); }
  void observeTimes(WaitingCloud& waiting);
  bool isQueueTooLong() const;
  void followTimes(const ScanMotion& motion, EchoClock& clock);
  void tellStrangeTimes(EchoClock& clock);
  void place(WaitingCloud cloud);
  void suspect(WaitingCloud cloud);
  void suspect(const nav_msgs::Odometry& odometry);
  void use(const nav_msgs::Odometry& odometry);
  void dropSuspect();
  void watchFlood();
  void suspectOrigin(const ScanMotion& motion, const WaitingCloud& waiting);
  void findSecondReturns(const Eigen::Vector3f& sensor);
  void followTrack(const ScanMotion& motion);
  void followOdometry(const ScanMotion& motion);
  void completeOdometry(const ScanMotion& motion);
  void startAnew(const std::string& why);
  MotionAnswer motionOf(const WaitingCloud& waiting, bool settle);
  void label(const WaitingCloud& waiting, const ScanMotion& motion);
  void moveToOrigin(const Eigen::Vector3d& origin);
  void remark();
  void tellSensor();
  Eigen::Vector3d toldOrigin() const;
  Eigen::Vector3d originOf(const WaitingCloud& waiting) const;
  void refuse(OdometryRefusal refusal, const std::string& text);
  void drop(DropReason reason, const std::string& text);

  Config config_;
  PipelineEvents events_;
  MotionSource motion_;
  CloudPlacer placer_;
  GivenOdometry given_;
  FloodWatch flood_;
  OriginWatch origin_watch_;
  int without_ground_ = 0;  // clouds in a row
  std::shared_ptr<Detector> detector_;
  EchoClocks clocks_;
  bool watched_ = false;
  bool is_sensor_told_ = false;
  PipelineCounts counts_;
  CloudOrder order_;
  std::deque<WaitingCloud> waiting_;  // by stamp

  // One old message is a straggler, two in a row are a clock that ran back: the first is kept until that is known.
  std::optional<WaitingCloud> suspect_cloud_;
  std::optional<nav_msgs::Odometry> suspect_odometry_;

  // Of the scan in hand; kept for their memory. A cloud is parsed while it waits for odometry, once.
  std::size_t parsed_ = 0;     // the number of the cloud that scan_ and times_ hold
  double parsing_time_ = 0.0;  // [s]
  Scan scan_;
  SecondReturns second_returns_;
  double first_arrival_ = std::numeric_limits<double>::infinity();  // of a cloud [s]
  NoReturns no_returns_;
  CloudRemarks remarks_;
  std::array<bool, kCloudRemarks> remarked_{};  // kinds that have been told
  EchoTimes times_;
  EchoLabels labels_;
};

}  // namespace donex
