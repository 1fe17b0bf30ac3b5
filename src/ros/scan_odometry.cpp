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
  if (!base_from_first_) base_from_first_ = base_from_sensor;
  const TrackedScan& tracked = odometry_.locate(stamp, asFirstSensor(echoes, base_from_sensor), times);
  if (tracked.is_new_track) track_.reset();
  OdometrySample sample;
  sample.stamp = tracked.moment;
  // The odometry frame is where the vehicle was at the start, not the sensor.
  sample.odom_from_base = *base_from_first_ * tracked.odom_from_sensor * base_from_first_->inverse();
  track_.add(sample);
  // In a turn the pose at the stamp is another one than in the middle of the scan.
  const auto at_stamp = track_.poseAt(stamp);
  odom_from_base_ = at_stamp ? *at_stamp : sample.odom_from_base;
  return tracked;
}

const std::vector<Eigen::Vector3f>& ScanOdometry::asFirstSensor(const std::vector<Eigen::Vector3f>& echoes,
                                                                const Eigen::Isometry3d& base_from_sensor) {
  if (base_from_sensor.isApprox(*base_from_first_)) return echoes;
  const Eigen::Isometry3f first_from_sensor = (base_from_first_->inverse() * base_from_sensor).cast<float>();
  moved_.clear();
  for (const Eigen::Vector3f& echo : echoes) moved_.push_back(first_from_sensor * echo);
  return moved_;
}

void ScanOdometry::reset() {
  base_from_first_.reset();
  odometry_.reset();
  track_.reset();
  odom_from_base_.setIdentity();
}

}  // namespace donex
