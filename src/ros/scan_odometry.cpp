#include "ros/scan_odometry.h"

namespace donex {
namespace {

/// The echoes of a slow scan end this long after its stamp [s].
constexpr double kLongestScan = 0.25;

EgoMotion::Options trackOptions() {
  EgoMotion::Options options;
  options.max_extrapolation = kLongestScan;
  return options;
}

}  // namespace

ScanOdometry::ScanOdometry() : track_(trackOptions()) {}

const TrackedScan& ScanOdometry::locate(double stamp, const std::vector<Eigen::Vector3f>& echoes,
                                        const std::vector<float>& times, const Eigen::Isometry3d& base_from_sensor) {
  const TrackedScan& tracked = odometry_.locate(stamp, echoes, times);
  if (tracked.is_new_track) track_.reset();
  OdometrySample sample;
  sample.stamp = tracked.moment;
  // The odometry frame is where the vehicle was at the start, not the sensor.
  sample.odom_from_base = base_from_sensor * tracked.odom_from_sensor * base_from_sensor.inverse();
  track_.add(sample);
  // In a turn the pose at the stamp is another one than in the middle of the scan.
  const auto at_stamp = track_.poseAt(stamp);
  odom_from_base_ = at_stamp ? *at_stamp : sample.odom_from_base;
  return tracked;
}

void ScanOdometry::reset() {
  odometry_.reset();
  track_.reset();
  odom_from_base_.setIdentity();
}

}  // namespace donex
