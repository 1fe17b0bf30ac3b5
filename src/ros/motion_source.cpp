#include "ros/motion_source.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include <tf2/exceptions.h>
#include <tf2_eigen/tf2_eigen.h>

namespace donex {
namespace {

/// tf is asked this often within a scan [s]; between, the motion is interpolated.
constexpr double kTfStep = 0.005;

/// Times a driver rounds to floats or nanoseconds may miss the odometry they were taken with by this much [s].
constexpr double kTimeRounding = 1e-6;

/// Odometry that has been silent for so long makes way for one of other frames [s].
constexpr double kSourceSilence = 1.0;

template <class... Parts>
std::string textOf(const Parts&... parts) {
  std::ostringstream text;
  text.precision(3);
  text << std::fixed;
  (text << ... << parts);
  return text.str();
}

/// tf2 knows no leading slashes; old drivers write them.
std::string frameName(const std::string& frame) { return !frame.empty() && frame[0] == '/' ? frame.substr(1) : frame; }

EgoMotion::Options optionsFor(const MotionConfig& config) {
  EgoMotion::Options options;
  options.source = config.source == OdometrySource::kTwist ? EgoMotion::Source::kTwist : EgoMotion::Source::kPose;
  options.max_extrapolation = config.max_extrapolation;
  return options;
}

OdometryVerdict refusedFor(OdometryRefusal refusal, std::string text) {
  return {OdometryVerdict::Kind::kRefused, refusal, std::move(text)};
}

OdometryVerdict verdictOn(AddResult result, double stamp) {
  using Kind = OdometryVerdict::Kind;
  switch (result) {
    case AddResult::kAccepted: return {};
    case AddResult::kDuplicate:
      return refusedFor(OdometryRefusal::kDuplicate, textOf("a second odometry with stamp ", stamp, " s"));
    case AddResult::kTooOld:
      return refusedFor(OdometryRefusal::kTooOld, textOf("odometry of ", stamp, " s is older than all that is kept"));
    case AddResult::kTimeRanBack:
      return {Kind::kTimeRanBack, {}, textOf("odometry of ", stamp, " s is much older than the newest")};
    case AddResult::kTrackLost:
      return {Kind::kNewTrack, {}, textOf("the odometry's twist was missing for too long before ", stamp, " s")};
    case AddResult::kNonFinite: break;
  }
  return refusedFor(OdometryRefusal::kNonFinite, textOf("odometry of ", stamp, " s is not finite"));
}

/// The mean velocity from one pose to the next, in the axes of the first.
Twist twistBetween(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, double elapsed) {
  const Eigen::Isometry3d motion = from.inverse() * to;
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(motion.linear()));
  return {motion.translation() / elapsed, turn.axis() * (turn.angle() / elapsed)};
}

Twist twistOf(const nav_msgs::Odometry& odometry) {
  const auto& linear = odometry.twist.twist.linear;
  const auto& angular = odometry.twist.twist.angular;
  return {{linear.x, linear.y, linear.z}, {angular.x, angular.y, angular.z}};
}

MotionResult<Eigen::Isometry3d> poseOf(const nav_msgs::Odometry& odometry) {
  const auto& p = odometry.pose.pose.position;
  const auto& q = odometry.pose.pose.orientation;
  return checkedPose({p.x, p.y, p.z}, {q.w, q.x, q.y, q.z});
}

MotionMissing missing(MotionFault fault, double stamp) {
  const std::string text = textOf(describe(fault), " (cloud of ", stamp, " s)");
  switch (fault) {
    case MotionFault::kNoSamples:
    case MotionFault::kNotYetCovered: return {DropReason::kNoOdometry, text, true};
    case MotionFault::kTooOld: return {DropReason::kBeforeOdometry, text, false};
    case MotionFault::kGapTooLong: return {DropReason::kOdometryGap, text, false};
    default: return {DropReason::kInternalError, text, false};
  }
}

}  // namespace

MotionSource::MotionSource(const MotionConfig& config, const tf2::BufferCore& tf)
    : config_(config), source_(config.source), tf_(tf), odometry_(optionsFor(config)) {}

void MotionSource::reset() {
  odometry_.reset();
  pose_and_twist_.reset();
  ++track_number_;
  scan_odometry_.reset();
  mountings_.clear();
}

bool MotionSource::wantsOdometry() const { return usesOdometry(source_) || source_ == OdometrySource::kAuto; }

void MotionSource::learn(const std::vector<std::uint8_t>& dynamic) {
  if (source_ == OdometrySource::kLidar) scan_odometry_.learn(dynamic);
}

MotionSource::Frames MotionSource::framesOf(const nav_msgs::Odometry& odometry) const {
  const std::string& child = odometry.child_frame_id;
  return {frameName(child.empty() ? config_.base_frame : child), frameName(odometry.header.frame_id)};
}

/// How many of the two are those of the configuration.
int MotionSource::configured(const Frames& frames) const {
  return (frames.base == frameName(config_.base_frame) ? 1 : 0) +
         (frames.odom == frameName(config_.fixed_frame) ? 1 : 0);
}

/// Whether the odometry in use goes on beside this one, and is not to make way for it.
bool MotionSource::isSecondSource(const Frames& frames, double stamp) const {
  if (frames == frames_ || odometry_.empty()) return false;
  const bool goes_on = std::abs(stamp - odometry_.newestStamp()) < kSourceSilence;
  return goes_on && configured(frames) <= configured(frames_);
}

bool MotionSource::adoptFrames(const nav_msgs::Odometry& odometry) {
  const Frames frames = framesOf(odometry);
  if (frames == frames_) return false;
  const bool first = frames_.base.empty();
  frames_ = frames;
  odometry_.reset();
  return !first;
}

OdometryVerdict MotionSource::add(const nav_msgs::Odometry& odometry) {
  const double stamp = odometry.header.stamp.toSec();
  const bool nameless = odometry.header.frame_id.empty() || (odometry.child_frame_id + config_.base_frame).empty();
  if (nameless) return refusedFor(OdometryRefusal::kNoFrame, textOf("odometry of ", stamp, " s names no frames"));
  const Frames frames = framesOf(odometry);
  if (isSecondSource(frames, stamp)) {
    return refusedFor(
        OdometryRefusal::kOtherSource,
        textOf("two sources on the odometry topic: '", frames_.base, "' in '", frames_.odom, "', which is used, and '",
               frames.base, "' in '", frames.odom, "'; fixed_frame and base_frame choose, or take the topic of one"));
  }
  OdometrySample sample;
  sample.stamp = stamp;
  sample.twist = twistOf(odometry);
  if (source_ == OdometrySource::kTwist) return addSample(odometry, sample);

  const auto pose = poseOf(odometry);
  if (pose) {
    sample.odom_from_base = *pose;
    if (pose_and_twist_.standsStill(sample)) return standingStill(sample);
    return addSample(odometry, sample);
  }
  const bool is_no_rotation = pose.fault() == MotionFault::kNonUnitQuaternion;
  return refusedFor(is_no_rotation ? OdometryRefusal::kNonUnitQuaternion : OdometryRefusal::kNonFinite,
                    textOf("odometry of ", stamp, " s: ", describe(pose.fault())));
}

OdometryVerdict MotionSource::standingStill(const OdometrySample& sample) const {
  return refusedFor(OdometryRefusal::kStandsStill,
                    textOf("odometry of ", sample.stamp, " s: its pose has not changed for ", pose_and_twist_.time(),
                           " s while its twist led ", pose_and_twist_.way(),
                           " m away; where nobody fills in the pose, set odometry_source: twist"));
}

OdometryVerdict MotionSource::addSample(const nav_msgs::Odometry& odometry, const OdometrySample& sample) {
  const bool frames_changed = adoptFrames(odometry);
  OdometryVerdict verdict = verdictOn(odometry_.add(sample), sample.stamp);
  const bool is_new_track = frames_changed || verdict.kind == OdometryVerdict::Kind::kNewTrack;
  if (is_new_track) ++track_number_;
  if (!frames_changed) return verdict;
  return {
      OdometryVerdict::Kind::kNewTrack, {}, textOf("odometry now moves '", frames_.base, "' in '", frames_.odom, "'")};
}

std::variant<Eigen::Isometry3d, MotionMissing> MotionSource::lookup(const std::string& target,
                                                                    const std::string& source,
                                                                    const ros::Time& stamp) const {
  if (target == source && !target.empty()) return Eigen::Isometry3d::Identity();
  try {
    return tf2::transformToEigen(tf_.lookupTransform(target, source, stamp));
  } catch (const tf2::TransformException& error) {
    return MotionMissing{DropReason::kNoTransform, textOf("tf '", target, "' <- '", source, "': ", error.what()), true};
  }
}

MotionAnswer MotionSource::during(const ScanTimes& times, const std::string& sensor_frame, bool settle,
                                  const std::vector<Eigen::Vector3f>& echoes) {
  const std::string sensor = frameName(sensor_frame);
  if (source_ == OdometrySource::kAuto) {
    if (const auto nothing = choose(times, settle)) return *nothing;
  }
  switch (source_) {
    case OdometrySource::kNone: {
      // At rest the sensor itself is the vehicle: nothing is missing that a transform could tell.
      ScanMotion at_rest;
      at_rest.odom_frame = at_rest.base_frame = sensor;
      return at_rest;
    }
    case OdometrySource::kTf: return fromTf(times, sensor);
    case OdometrySource::kLidar: return fromScans(times, sensor, settle, echoes);
    default: return fromOdometry(times, sensor, settle);
  }
}

/// Odometry where some has come while the first cloud waited, else tf, else the clouds. What is chosen stays.
std::optional<MotionMissing> MotionSource::choose(const ScanTimes& times, bool settle) {
  const std::string fixed = frameName(config_.fixed_frame), base = frameName(config_.base_frame);
  if (!odometry_.empty()) {
    source_ = OdometrySource::kPose;
    choice_ = "ego motion from odometry messages";
  } else if (!settle) {
    return MotionMissing{DropReason::kNoOdometry, "no odometry yet", true};
  } else if (!times.stamp.isZero() && tf_.canTransform(fixed, base, times.stamp)) {
    source_ = OdometrySource::kTf;
    choice_ = textOf("ego motion from tf '", fixed, "' <- '", base, "': there are no odometry messages");
  } else {
    source_ = OdometrySource::kLidar;
    choice_ = textOf("ego motion from the clouds: there are no odometry messages and no tf '", fixed, "' <- '", base,
                     "'; odometry_source, odom, fixed_frame and base_frame say otherwise");
  }
  return std::nullopt;
}

/// From tf where that knows the vehicle's frame; else the first sensor is the vehicle.
std::optional<MotionMissing> MotionSource::mount(const ScanTimes& times, const std::string& sensor_frame, bool settle) {
  if (mountings_.count(sensor_frame) > 0) return std::nullopt;
  const bool is_first = mountings_.empty();
  const std::string vehicle = is_first ? frameName(config_.base_frame) : mounted_frame_;
  const auto found = lookup(vehicle, sensor_frame, times.stamp);
  const auto* mounting = std::get_if<Eigen::Isometry3d>(&found);
  if (mounting == nullptr && !(settle && is_first)) return std::get<MotionMissing>(found);
  mountings_[sensor_frame] = mounting != nullptr ? *mounting : Eigen::Isometry3d::Identity();
  if (is_first) mounted_frame_ = mounting != nullptr ? vehicle : sensor_frame;
  return std::nullopt;
}

MotionAnswer MotionSource::fromScans(const ScanTimes& times, const std::string& sensor_frame, bool settle,
                                     const std::vector<Eigen::Vector3f>& echoes) {
  if (const auto nothing = mount(times, sensor_frame, settle)) return *nothing;
  const Eigen::Isometry3d& mounting = mountings_.at(sensor_frame);
  const double stamp = times.stamp.toSec();
  const Eigen::Isometry3d before = scan_odometry_.odomFromBase();
  const EgoMotion& track = scan_odometry_.track();
  const double stamp_before = scan_odometry_.stamp();
  const bool is_under_way = !track.empty();
  ScanMotion motion;
  const std::vector<float> none;
  motion.tracked = scan_odometry_.locate(stamp, echoes, times.of_echoes != nullptr ? *times.of_echoes : none, mounting);
  if (motion.tracked->status == TrackingStatus::kLost) {
    return MotionMissing{DropReason::kLost,
                         textOf("the cloud of ", stamp, " s does not fit those before, or is too small"), false};
  }
  motion.base_from_sensor = mounting;
  motion.odom_from_base = scan_odometry_.odomFromBase();
  motion.odom_frame = frameName(config_.fixed_frame);
  motion.base_frame = mounted_frame_;
  const double elapsed = stamp - stamp_before;
  const bool has_velocity = is_under_way && !motion.tracked->is_new_track && elapsed > 0.0;
  if (has_velocity) motion.twist = twistBetween(before, motion.odom_from_base, elapsed);
  const bool is_covered = track.poseAt(stamp + times.first) && track.poseAt(stamp + times.last);
  if (times.spanTime() && is_covered) motion.track = &track;  // not of the first scan of a track
  return motion;
}

MotionAnswer MotionSource::fromOdometry(const ScanTimes& times, const std::string& sensor_frame, bool settle) const {
  const double stamp = times.stamp.toSec();
  const double last = stamp + times.last;
  if (odometry_.empty()) return missing(MotionFault::kNoSamples, stamp);
  const double lag = last - odometry_.newestStamp();
  if (lag > kTimeRounding && (!settle || lag > config_.max_extrapolation)) {
    return MotionMissing{DropReason::kNoOdometry,
                         textOf("the newest odometry is ", lag, " s older than the last echo of the cloud of ", stamp,
                                " s, ", times.last, " s after its stamp"),
                         true};
  }
  for (const double moment : {stamp + times.first, last, stamp}) {
    const auto pose = odometry_.poseAt(moment);
    if (!pose) return missing(pose.fault(), stamp);
  }
  const auto mounting = lookup(frames_.base, sensor_frame, times.stamp);
  if (const auto* nothing = std::get_if<MotionMissing>(&mounting)) return *nothing;

  ScanMotion motion;
  motion.base_from_sensor = std::get<Eigen::Isometry3d>(mounting);
  motion.odom_from_base = *odometry_.poseAt(stamp);
  motion.odom_frame = frames_.odom;
  motion.base_frame = frames_.base;
  if (times.spanTime()) motion.track = &odometry_;
  addMidway(times, odometry_, motion);
  return motion;
}

MotionAnswer MotionSource::fromTf(const ScanTimes& times, const std::string& sensor_frame) {
  // tf takes time zero for "the latest there is".
  if (times.stamp.isZero()) return MotionMissing{DropReason::kNoTransform, "the cloud has no stamp", false};
  const auto mounting = lookup(frameName(config_.base_frame), sensor_frame, times.stamp);
  if (const auto* nothing = std::get_if<MotionMissing>(&mounting)) return *nothing;
  if (const auto nothing = trackFromTf(times)) return *nothing;
  ScanMotion motion;
  motion.base_from_sensor = std::get<Eigen::Isometry3d>(mounting);
  motion.odom_from_base = *tf_track_.poseAt(times.stamp.toSec());
  motion.odom_frame = frameName(config_.fixed_frame);
  motion.base_frame = frameName(config_.base_frame);
  if (times.spanTime()) motion.track = &tf_track_;
  addMidway(times, tf_track_, motion);
  return motion;
}

void MotionSource::addMidway(const ScanTimes& times, const EgoMotion& track, ScanMotion& motion) const {
  const double stamp = times.stamp.toSec(), middle = stamp + 0.5 * (times.first + times.last);
  const auto pose = track.poseAt(middle);
  motion.midway = pose ? ScanMotion::Sample{middle, *pose} : ScanMotion::Sample{stamp, motion.odom_from_base};
  motion.track_number = track_number_;
}

std::optional<MotionMissing> MotionSource::trackFromTf(const ScanTimes& times) {
  std::vector<double> moments{0.0, times.last};
  const auto steps = static_cast<int>(std::ceil((times.last - times.first) / kTfStep));
  for (int step = 0; step < steps; ++step) moments.push_back(times.first + step * kTfStep);
  std::sort(moments.begin(), moments.end());
  tf_track_.reset();
  for (const double moment : moments) {
    const ros::Time time = times.stamp + ros::Duration(moment);
    const auto pose = lookup(frameName(config_.fixed_frame), frameName(config_.base_frame), time);
    if (const auto* nothing = std::get_if<MotionMissing>(&pose)) return *nothing;
    OdometrySample sample;
    sample.stamp = times.stamp.toSec() + moment;
    sample.odom_from_base = std::get<Eigen::Isometry3d>(pose);
    tf_track_.add(sample);
  }
  return std::nullopt;
}

}  // namespace donex
