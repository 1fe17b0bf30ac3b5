#include "core/motion/planar_completion.h"

#include <algorithm>
#include <cmath>

#include "core/motion/rotation_vector.h"

namespace donex {
namespace {

RegistrationOptions outOfThePlane(RegistrationOptions options) {
  options.along_ground = false;
  return options;
}

EchoSelection::Options selectionOf(const PlanarCompletion::Options& options) {
  EchoSelection::Options selection;
  selection.farthest = options.near_ground;
  selection.map_edge = options.kept_edge;
  selection.least_source = options.least_to_register;
  return selection;
}

}  // namespace

void PlaneWatch::follow(const Eigen::Isometry3d& odom_from_base) {
  if (!has_first_) first_ = odom_from_base;
  has_first_ = true;
  const Eigen::Vector3d way = odom_from_base.translation() - first_.translation();
  // About the frame's vertical, not the vehicle's: one that sits askew stays in its plane, too.
  const Eigen::Matrix3d turn = odom_from_base.linear() * first_.linear().transpose();
  left_ = left_ || std::abs(way.z()) > options_.height || turn.col(2).head<2>().norm() > options_.tilt;
  has_moved_ = has_moved_ || way.norm() > options_.way;
}

PlanarCompletion::PlanarCompletion(const Options& options)
    : options_(options),
      plane_(options.plane),
      selection_(selectionOf(options)),
      registration_(outOfThePlane(options.registration)),
      whole_registration_(options.registration) {}

void PlanarCompletion::reset() {
  plane_.reset();
  begin();
  to_keep_.clear();
  tilt_.setZero();
  lift_ = yaw_ = 0.0;
  completed_from_given_.setIdentity();
}

void PlanarCompletion::begin() {
  if (map_) map_->clear();
  has_map_ = false;
  predicted_since_.reset();
}

Eigen::Isometry3d PlanarCompletion::complete(double stamp, const std::vector<Eigen::Vector3f>& echoes,
                                             const Eigen::Isometry3d& base_from_sensor,
                                             const Eigen::Isometry3d& odom_from_base) {
  plane_.follow(odom_from_base);
  if (!isActive()) {
    to_keep_.clear();
    return completed_from_given_ * odom_from_base;
  }
  if (!map_) map_.emplace(options_.map);  // not before: it is large
  keep();
  select(echoes, base_from_sensor);
  if (has_map_) climb(odom_from_base);
  given_ = odom_from_base;
  map_->moveTo(completed().translation());
  const bool is_scan = source_.size() >= options_.least_echoes;
  if (has_map_ && is_scan) find(stamp);
  has_map_ = has_map_ || is_scan;
  const Eigen::Isometry3d pose = completed();
  completed_from_given_ = pose * odom_from_base.inverse();
  return pose;
}

/// Tilted as it was, the vehicle has come higher on its way here.
void PlanarCompletion::climb(const Eigen::Isometry3d& odom_from_base) {
  const Eigen::Vector3d way = odom_from_base.translation() - given_.translation();
  lift_ += (rotationBy(tilt_) * way - way).z();
}

void PlanarCompletion::find(double stamp) {
  const Eigen::Isometry3d prediction = completed();
  yaw_ = yawToMend(prediction);
  const Registration registration = registration_.align(*map_, source_, completed(), options_.gate);
  if (isSound(registration, prediction)) {
    take(registration.map_from_sensor);
    return;
  }
  if (!predicted_since_) predicted_since_ = stamp;
  if (stamp - *predicted_since_ >= options_.new_map_after) {
    begin();  // with this scan
  } else {
    to_keep_.clear();
  }
}

/// By which the given yaw is wrong, as far as the scans are to be believed.
double PlanarCompletion::yawToMend(const Eigen::Isometry3d& prediction) {
  const Registration registration = whole_registration_.align(*map_, source_, prediction, options_.gate);
  if (!isSound(registration, prediction)) return 0.0;
  const double yaw = rotationVectorOf(registration.map_from_sensor.linear() * given_.linear().transpose()).z();
  if (std::abs(yaw) < options_.least_yaw) return 0.0;
  return std::min(std::max(yaw, -options_.most_yaw), options_.most_yaw);
}

void PlanarCompletion::select(const std::vector<Eigen::Vector3f>& echoes, const Eigen::Isometry3d& base_from_sensor) {
  selection_.select(echoes);
  const Eigen::Isometry3f move = base_from_sensor.cast<float>();
  source_.clear();
  for (const std::uint32_t i : selection_.toRegister()) source_.push_back(move * echoes[i]);
  to_keep_.clear();
  for (const std::uint32_t i : selection_.forMap()) to_keep_.push_back(move * echoes[i]);
}

bool PlanarCompletion::isSound(const Registration& registration, const Eigen::Isometry3d& prediction) const {
  const auto matched = static_cast<double>(registration.matched), all = static_cast<double>(source_.size());
  const bool fits = matched >= options_.least_matched * all &&
                    static_cast<double>(registration.fitting) >= options_.least_fitting * matched;
  if (!fits || registration.undetermined == 6) return false;
  const Eigen::Isometry3d& found = registration.map_from_sensor;
  const double lift = std::abs(found.translation().z() - prediction.translation().z());
  const double tilt = rotationVectorOf(found.linear() * prediction.linear().transpose()).norm();
  return lift <= options_.most_lift && tilt <= options_.most_tilt;
}

Eigen::Isometry3d PlanarCompletion::completed() const {
  Eigen::Isometry3d pose = given_;
  pose.linear() = rotationBy(tilt_ + yaw_ * Eigen::Vector3d::UnitZ()) * given_.linear();
  pose.translation().z() += lift_;
  return pose;
}

void PlanarCompletion::take(const Eigen::Isometry3d& found) {
  tilt_ = rotationVectorOf(found.linear() * given_.linear().transpose());
  tilt_.z() = 0.0;  // yaw is found beforehand
  lift_ = found.translation().z() - given_.translation().z();
  predicted_since_.reset();
}

void PlanarCompletion::learn(const std::vector<std::uint8_t>& dynamic) {
  if (to_keep_.empty()) return;
  selection_.leaveOutMoving(dynamic, to_keep_);
  keep();
}

void PlanarCompletion::keep() {
  const Eigen::Isometry3d pose = completed();
  for (const Eigen::Vector3f& echo : to_keep_) map_->add(pose * echo.cast<double>());
  to_keep_.clear();
}

}  // namespace donex
