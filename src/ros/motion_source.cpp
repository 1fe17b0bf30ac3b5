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
    : config_(config), tf_(tf), odometry_(optionsFor(config)) {}

void MotionSource::reset() { odometry_.reset(); }

bool MotionSource::adoptFrames(const nav_msgs::Odometry& odometry) {
  const std::string child = odometry.child_frame_id.empty() ? config_.base_frame : odometry.child_frame_id;
  const std::string base = frameName(child), odom = frameName(odometry.header.frame_id);
  const bool same = base == base_frame_ && odom == odom_frame_;
  if (same) return false;
  const bool first = base_frame_.empty();
  base_frame_ = base;
  odom_frame_ = odom;
  odometry_.reset();
  return !first;
}

OdometryVerdict MotionSource::add(const nav_msgs::Odometry& odometry) {
  const double stamp = odometry.header.stamp.toSec();
  const bool nameless = odometry.header.frame_id.empty() || (odometry.child_frame_id + config_.base_frame).empty();
  if (nameless) return refusedFor(OdometryRefusal::kNoFrame, textOf("odometry of ", stamp, " s names no frames"));
  OdometrySample sample;
  sample.stamp = stamp;
  sample.twist = twistOf(odometry);
  if (config_.source != OdometrySource::kPose) return addSample(odometry, sample);

  const auto pose = poseOf(odometry);
  if (pose) {
    sample.odom_from_base = *pose;
    return addSample(odometry, sample);
  }
  const bool is_no_rotation = pose.fault() == MotionFault::kNonUnitQuaternion;
  return refusedFor(is_no_rotation ? OdometryRefusal::kNonUnitQuaternion : OdometryRefusal::kNonFinite,
                    textOf("odometry of ", stamp, " s: ", describe(pose.fault())));
}

OdometryVerdict MotionSource::addSample(const nav_msgs::Odometry& odometry, const OdometrySample& sample) {
  const bool frames_changed = adoptFrames(odometry);
  OdometryVerdict verdict = verdictOn(odometry_.add(sample), sample.stamp);
  if (!frames_changed) return verdict;
  return {
      OdometryVerdict::Kind::kNewTrack, {}, textOf("odometry now moves '", base_frame_, "' in '", odom_frame_, "'")};
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

MotionAnswer MotionSource::during(const ScanTimes& times, const std::string& sensor_frame, bool settle) {
  const std::string sensor = frameName(sensor_frame);
  switch (config_.source) {
    case OdometrySource::kNone: {
      // At rest the sensor itself is the vehicle: nothing is missing that a transform could tell.
      ScanMotion at_rest;
      at_rest.odom_frame = sensor;
      return at_rest;
    }
    case OdometrySource::kTf: return fromTf(times, sensor);
    default: return fromOdometry(times, sensor, settle);
  }
}

MotionAnswer MotionSource::fromOdometry(const ScanTimes& times, const std::string& sensor_frame, bool settle) const {
  const double stamp = times.stamp.toSec();
  const double last = stamp + times.last;
  if (odometry_.empty()) return missing(MotionFault::kNoSamples, stamp);
  const double lag = last - odometry_.newestStamp();
  if (lag > kTimeRounding && (!settle || lag > config_.max_extrapolation)) {
    return MotionMissing{DropReason::kNoOdometry,
                         textOf("the newest odometry is ", lag, " s older than the cloud of ", stamp, " s"), true};
  }
  for (const double moment : {stamp + times.first, last, stamp}) {
    const auto pose = odometry_.poseAt(moment);
    if (!pose) return missing(pose.fault(), stamp);
  }
  const auto mounting = lookup(base_frame_, sensor_frame, times.stamp);
  if (const auto* nothing = std::get_if<MotionMissing>(&mounting)) return *nothing;

  ScanMotion motion;
  motion.base_from_sensor = std::get<Eigen::Isometry3d>(mounting);
  motion.odom_from_base = *odometry_.poseAt(stamp);
  motion.odom_frame = odom_frame_;
  if (times.spanTime()) motion.track = &odometry_;
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
  if (times.spanTime()) motion.track = &tf_track_;
  return motion;
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
