#include "ros/cloud_placer.h"

#include <cmath>

#include <tf2/exceptions.h>
#include <tf2_eigen/tf2_eigen.h>

namespace donex {
namespace {

/// A sensor that turns or nods on the vehicle keeps its place to this [m]; a frame that stands still does not.
constexpr double kStaysWithin = 1.0;
constexpr std::size_t kMostFrames = 64;  // of clouds on one topic; more are no sensors, and nothing is kept of them

std::string withoutSlash(const std::string& frame) {
  return !frame.empty() && frame[0] == '/' ? frame.substr(1) : frame;
}

MotionMissing refusal(const std::string& text, bool may_come) { return {DropReason::kNoTransform, text, may_come}; }

}  // namespace

CloudPlacer::CloudPlacer(const Config& config, const tf2::BufferCore& tf)
    : config_(config.cloud), fixed_frame_(withoutSlash(config.motion.fixed_frame)), tf_(tf) {
  config_.sensor_frame = withoutSlash(config_.sensor_frame);
}

std::string CloudPlacer::movingFrame(const std::string& cloud_frame, OdometrySource source) const {
  // The clouds' own motion is found in them, in whatever frame of the vehicle they are told.
  const bool is_told = source != OdometrySource::kLidar && source != OdometrySource::kNone;
  return is_told && !config_.sensor_frame.empty() ? config_.sensor_frame : cloud_frame;
}

std::optional<MotionMissing> CloudPlacer::refuseMoving(const std::string& frame, const ScanMotion& motion) {
  const bool is_fixed = frame == motion.odom_frame && motion.odom_frame != motion.base_frame;
  const Eigen::Vector3d place = motion.base_from_sensor.translation();
  if (first_places_.size() >= kMostFrames) first_places_.clear();
  const Eigen::Vector3d& first = first_places_.emplace(frame, place).first->second;
  const bool moves = (place - first).norm() > kStaysWithin;
  if (!is_fixed && !moves) return std::nullopt;
  return refusal("the vehicle moves in '" + frame +
                     "', the frame of the clouds: where their sensor was is not known; set sensor_frame",
                 false);
}

std::optional<MotionMissing> CloudPlacer::place(const ros::Time& stamp, const std::string& cloud_frame,
                                                OdometrySource source, ScanMotion& motion) {
  const std::string cloud = withoutSlash(cloud_frame);
  const std::string& sensor = config_.sensor_frame;
  const bool is_found = source == OdometrySource::kLidar;
  const bool is_fixed = source != OdometrySource::kNone && (cloud == motion.odom_frame || cloud == fixed_frame_);
  if (is_fixed && is_found) {
    return refusal("clouds in '" + cloud + "', which stands still, do not tell how their sensor moved", false);
  }
  if (sensor.empty() || sensor == cloud) return refuseMoving(cloud, motion);
  if (is_fixed && cloud == motion.odom_frame) {
    motion.sensor_from_cloud = (motion.odom_from_base * motion.base_from_sensor).inverse();
  } else {
    try {
      motion.sensor_from_cloud = tf2::transformToEigen(tf_.lookupTransform(sensor, cloud, stamp));
    } catch (const tf2::TransformException& error) {
      return refusal("sensor_frame, tf '" + sensor + "' <- '" + cloud + "': " + error.what(), true);
    }
  }
  if (is_found || source == OdometrySource::kNone) {
    motion.base_from_sensor = motion.base_from_sensor * motion.sensor_from_cloud->inverse();
  }
  if (is_fixed) motion.track = nullptr;  // each echo was put where it belongs when the cloud was registered
  return std::nullopt;
}

void moveEchoes(const Eigen::Isometry3d& motion, std::vector<Eigen::Vector3f>& echoes) {
  const Eigen::Isometry3f move = motion.cast<float>();
  for (Eigen::Vector3f& echo : echoes) echo = move * echo;
}

}  // namespace donex
