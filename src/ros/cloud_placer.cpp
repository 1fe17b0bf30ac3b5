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

bool liesOnTheGround(const std::vector<Eigen::Vector3f>& echoes) {
  constexpr float kNear = 2.0F, kFar = 6.0F;       // around the origin [m]: there the ground is flat
  constexpr float kLevel = 0.08F, kBelow = 0.15F;  // of the ground [m]
  constexpr std::size_t kEnough = 200;             // echoes
  std::size_t all = 0, level = 0, below = 0;
  for (const Eigen::Vector3f& echo : echoes) {
    const float range = echo.head<2>().norm();
    const bool is_near = range > kNear && range < kFar;  // never with NaN
    if (!is_near) continue;
    ++all;
    level += std::abs(echo.z()) < kLevel ? 1U : 0U;
    below += echo.z() < -kBelow ? 1U : 0U;
  }
  return all >= kEnough && 10 * level > 3 * all && 50 * below < all;
}

std::string OriginWatch::follow(const std::vector<Eigen::Vector3f>& echoes, bool is_vehicle, const std::string& frame) {
  if (!is_vehicle || on_the_ground_ >= kCertain) return "";
  on_the_ground_ = liesOnTheGround(echoes) ? on_the_ground_ + 1 : 0;
  if (on_the_ground_ < kCertain) return "";
  return "the clouds are told in the vehicle's frame '" + frame +
         "', and its origin lies on the ground, where no sensor is: set sensor_frame, or origin_x, origin_y and "
         "origin_z, to where it is";
}

}  // namespace donex
