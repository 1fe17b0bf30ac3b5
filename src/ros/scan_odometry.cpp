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
                                        const Eigen::Isometry3d& base_from_sensor) {
  const TrackedScan& tracked = odometry_.locate(stamp, echoes);
  // The odometry frame is where the vehicle was at the start, not the sensor.
  odom_from_base_ = base_from_sensor * tracked.odom_from_sensor * base_from_sensor.inverse();
  if (tracked.is_new_track) track_.reset();
  OdometrySample sample;
  sample.stamp = stamp;
  sample.odom_from_base = odom_from_base_;
  track_.add(sample);
  return tracked;
}

void ScanOdometry::reset() {
  odometry_.reset();
  track_.reset();
  odom_from_base_.setIdentity();
}

}  // namespace donex
