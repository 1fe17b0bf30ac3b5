#include "ros/given_odometry.h"

#include "donex/whole_drive.h"

namespace donex {
namespace {

bool isGiven(const ScanMotion& motion, OdometrySource source) {
  return !motion.tracked && source != OdometrySource::kNone;
}

}  // namespace

GivenOdometry::GivenOdometry(const Config& config)
    : checks_(config.motion.odometry_check),
      completes_(config.motion.odometry_refine),
      takes_whole_drives_(needsWholeDrive(config.method)) {}

double GivenOdometry::jumpBefore(const Scan& scan, const ScanMotion& motion, OdometrySource source) {
  const bool may_forget = !takes_whole_drives_;  // what has been seen of a whole drive is its answer
  if (!checks_ || !may_forget || !isGiven(motion, source)) return 0.0;
  if (motion.track_number != track_number_) jump_.reset();
  track_number_ = motion.track_number;
  return jump_.follow(scan.stamp, scan.odom_from_base);
}

bool GivenOdometry::complete(Scan& scan, const ScanMotion& motion, OdometrySource source) {
  odom_from_world_.setIdentity();
  const bool is_registered = motion.sensor_from_cloud.has_value();  // by poses of six directions
  learns_ = completes_ && !is_registered && isGiven(motion, source);
  if (!learns_) return false;
  const Eigen::Isometry3d given = scan.odom_from_base;
  scan.odom_from_base = completion_.complete(scan.stamp, scan.echoes, scan.base_from_sensor, given);
  odom_from_world_ = given * scan.odom_from_base.inverse();
  return completion_.isActive();
}

void GivenOdometry::learn(const std::vector<std::uint8_t>& dynamic) {
  // A whole drive is shown several times, and has to have the same poses each time.
  if (learns_ && !takes_whole_drives_) completion_.learn(dynamic);
}

}  // namespace donex
