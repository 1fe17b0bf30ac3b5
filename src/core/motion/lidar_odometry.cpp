#include "core/motion/lidar_odometry.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "donex/motion/rigid_motion.h"

namespace donex {
namespace {

double turnOf(const Eigen::Isometry3d& motion) {
  return std::abs(Eigen::AngleAxisd(Eigen::Matrix3d(motion.linear())).angle());
}

double shareFitting(const Registration& registration) {
  return static_cast<double>(registration.fitting) /
         static_cast<double>(std::max<std::size_t>(1, registration.matched));
}

}  // namespace

const char* describe(TrackingStatus status) {
  switch (status) {
    case TrackingStatus::kStarting: return "starting";
    case TrackingStatus::kTracking: return "tracking";
    case TrackingStatus::kDegenerate: return "degenerate";
    case TrackingStatus::kLost: break;
  }
  return "lost";
}

LidarOdometry::LidarOdometry(const Options& options)
    : options_(options), map_(options.map), registration_(options.registration) {
  reset();
}

void LidarOdometry::reset() {
  map_.clear();
  last_ = TrackedScan();
  step_.setIdentity();
  step_time_ = 0.0;
  squared_error_ = options_.first_gate * options_.first_gate / 9.0;
  usual_fitting_ = 0.0;
  lost_ = 0;
  has_track_ = false;
  to_keep_.clear();
}

std::size_t LidarOdometry::memoryBytes() const {
  return map_.memoryBytes() + thinning_.memoryBytes() + ranges_.capacity() * sizeof(float) +
         (usable_.capacity() + for_map_.capacity() + picked_.capacity()) * sizeof(std::uint32_t) +
         (source_.capacity() + to_keep_.capacity()) * sizeof(Eigen::Vector3f);
}

const TrackedScan& LidarOdometry::locate(double stamp, const std::vector<Eigen::Vector3f>& echoes) {
  keep();
  echoes_ = echoes.size();
  select(echoes);
  if (has_track_) {
    follow(stamp);
  } else if (source_.size() >= options_.least_echoes) {
    startTrack(stamp, last_.odom_from_sensor);
  } else {
    last_.status = TrackingStatus::kLost;
  }
  const bool is_placed = last_.status != TrackingStatus::kLost;
  if (!is_placed) for_map_.clear();
  to_keep_.clear();
  for (const std::uint32_t i : for_map_) to_keep_.push_back(echoes[i]);
  return last_;
}

void LidarOdometry::follow(double stamp) {
  const double elapsed = std::max(0.0, stamp - last_stamp_);
  const Eigen::Isometry3d prediction = predicted(stamp);
  if (source_.size() < options_.least_echoes) return lose(prediction, stamp);
  map_.moveTo(prediction.translation());
  const Registration registration = registered(prediction, elapsed);
  if (isSound(registration, prediction, elapsed)) {
    accept(registration, prediction, stamp);
  } else {
    lose(prediction, stamp);
  }
}

/// The echoes that can be used, those of them for the map, and those to register.
void LidarOdometry::select(const std::vector<Eigen::Vector3f>& echoes) {
  findNear(echoes);
  const float nearest = nearest_ * nearest_, farthest = options_.farthest * options_.farthest;
  usable_.clear();
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    const float range = echoes[i].squaredNorm();
    if (range >= nearest && range <= farthest) usable_.push_back(static_cast<std::uint32_t>(i));  // never with NaN
  }
  for_map_.clear();
  thinning_.pick(echoes, usable_, options_.map_edge, for_map_);
  for (const float edge : options_.source_edges) {
    picked_.clear();
    thinning_.pick(echoes, for_map_, edge, picked_);
    if (picked_.size() >= options_.least_source) break;
  }
  source_.clear();
  for (const std::uint32_t i : picked_) source_.push_back(echoes[i]);
}

void LidarOdometry::findNear(const std::vector<Eigen::Vector3f>& echoes) {
  constexpr std::size_t kEnough = 1000;  // ranges for a median
  const std::size_t stride = std::max<std::size_t>(1, echoes.size() / kEnough);
  ranges_.clear();
  for (std::size_t i = 0; i < echoes.size(); i += stride) {
    const float range = echoes[i].norm();
    if (std::isfinite(range) && range > 0.0F) ranges_.push_back(range);
  }
  nearest_ = options_.nearest_least;
  if (ranges_.empty()) return;
  const auto middle = ranges_.begin() + static_cast<std::ptrdiff_t>(ranges_.size() / 2);
  std::nth_element(ranges_.begin(), middle, ranges_.end());
  nearest_ = std::min(std::max(options_.nearest_share * *middle, options_.nearest_least), options_.nearest_most);
}

Eigen::Isometry3d LidarOdometry::predicted(double stamp) const {
  if (!(step_time_ > 0.0)) return last_.odom_from_sensor;
  const double elapsed = std::min(std::max(0.0, stamp - last_stamp_), options_.longest_prediction);
  return last_.odom_from_sensor * interpolate(Eigen::Isometry3d::Identity(), step_, elapsed / step_time_);
}

/// From the prediction, and where that does not end well from farther away.
Registration LidarOdometry::registered(const Eigen::Isometry3d& prediction, double elapsed) {
  const double gate = std::min(std::max(3.0 * std::sqrt(squared_error_), options_.least_gate), options_.first_gate);
  const Registration first = registration_.align(map_, source_, prediction, gate);
  const bool has_velocity = step_time_ > 0.0 && lost_ == 0;
  if (has_velocity && isUsual(first) && isSound(first, prediction, elapsed)) return first;
  const double reach =
      has_velocity ? options_.search_step : std::min(options_.search_reach, options_.search_speed * elapsed);
  const Registration second = registration_.align(map_, source_, searched(prediction, reach), options_.search_step);
  // Along a tunnel everything fits: where the velocity is known it tells more.
  const bool is_open = has_velocity && second.undetermined > 0;
  return !is_open && fitnessOf(second) > options_.better_fitness * fitnessOf(first) ? second : first;
}

bool LidarOdometry::isUsual(const Registration& registration) const {
  return registration.undetermined == 0 && shareFitting(registration) > options_.usual_share * usual_fitting_;
}

double LidarOdometry::fitnessOf(const Registration& registration) {
  constexpr double kFitKernel = 0.15;  // [m]
  return registration_.fitness(map_, source_, registration.map_from_sensor, kFitKernel, 1);
}

/// The best of many starts around the prediction, first in place, then in yaw.
Eigen::Isometry3d LidarOdometry::searched(const Eigen::Isometry3d& prediction, double reach) {
  constexpr std::size_t kSome = 400;  // echoes that tell a good start from a bad one
  constexpr double kKernel = 0.3;     // [m]
  const std::size_t stride = std::max<std::size_t>(1, source_.size() / kSome);
  Eigen::Isometry3d best = prediction;
  double best_fitness = registration_.fitness(map_, source_, prediction, kKernel, stride);
  const auto attempt = [&](const Eigen::Isometry3d& start) {
    const double fitness = registration_.fitness(map_, source_, start, kKernel, stride);
    if (fitness <= best_fitness) return;
    best_fitness = fitness;
    best = start;
  };
  const double step = options_.search_step;
  for (double x = -reach; x <= reach; x += step) {
    for (double y = -reach; y <= reach; y += step) {
      if (x * x + y * y <= reach * reach) attempt(prediction * Eigen::Translation3d(x, y, 0.0));
    }
  }
  const Eigen::Isometry3d best_place = best;
  for (const double yaw : options_.search_yaws) {
    attempt(best_place * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
    attempt(prediction * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
  }
  return best;
}

bool LidarOdometry::isSound(const Registration& registration, const Eigen::Isometry3d& prediction,
                            double elapsed) const {
  const auto matched = static_cast<double>(registration.matched), all = static_cast<double>(source_.size());
  const bool fits =
      matched >= options_.least_matched * all &&
      shareFitting(registration) >= std::max(options_.least_fitting, options_.sound_share * usual_fitting_);
  if (!fits || registration.undetermined == 6) return false;
  const Eigen::Isometry3d change = prediction.inverse() * registration.map_from_sensor;
  const bool has_velocity = step_time_ > 0.0;
  const double time = std::max(elapsed, 0.05);  // neither at rest is a scan placed exactly
  const double most =
      has_velocity ? options_.most_acceleration * time * std::max(time, step_time_) : options_.search_speed * time;
  return change.translation().norm() <= most + 0.1 && turnOf(change) <= options_.most_turn * std::max(1.0, time / 0.1);
}

void LidarOdometry::startTrack(double stamp, const Eigen::Isometry3d& pose) {
  reset();
  has_track_ = true;
  last_.odom_from_sensor = pose;
  last_stamp_ = stamp;
  map_.moveTo(pose.translation());
}

void LidarOdometry::accept(const Registration& registration, const Eigen::Isometry3d& prediction, double stamp) {
  const Eigen::Isometry3d before = last_.odom_from_sensor;
  const bool knew_velocity = step_time_ > 0.0;
  last_.odom_from_sensor = orthonormalised(registration.map_from_sensor);
  last_.is_new_track = false;
  last_.undetermined = registration.undetermined;
  last_.least_information = registration.least_information;
  last_.fitting = shareFitting(registration);
  usual_fitting_ += 0.1 * (last_.fitting - usual_fitting_);
  last_.status = registration.undetermined > 0 ? TrackingStatus::kDegenerate
                 : knew_velocity               ? TrackingStatus::kTracking
                                               : TrackingStatus::kStarting;
  lost_ = 0;
  if (stamp > last_stamp_) {
    step_ = before.inverse() * last_.odom_from_sensor;
    step_time_ = stamp - last_stamp_;
    last_stamp_ = stamp;
  }
  if (knew_velocity) adaptGate(prediction);
}

void LidarOdometry::adaptGate(const Eigen::Isometry3d& prediction) {
  constexpr double kFading = 0.8;
  constexpr double kRange = 15.0;  // [m] where a turn moves echoes
  const Eigen::Isometry3d change = prediction.inverse() * last_.odom_from_sensor;
  const double error = change.translation().norm() + kRange * turnOf(change);
  squared_error_ = std::max(kFading * squared_error_ + (1.0 - kFading) * error * error, 0.0);
}

void LidarOdometry::lose(const Eigen::Isometry3d& prediction, double stamp) {
  const bool may_start = source_.size() >= options_.least_echoes;
  if (++lost_ > options_.most_lost && may_start) return startTrack(stamp, prediction);
  last_.odom_from_sensor = prediction;
  last_.status = TrackingStatus::kLost;
  last_.is_new_track = false;
  last_.undetermined = 6;
  last_.fitting = last_.least_information = 0.0;
  last_stamp_ = std::max(last_stamp_, stamp);
  if (lost_ * step_time_ > options_.longest_prediction) step_.setIdentity();
}

void LidarOdometry::learn(const std::vector<std::uint8_t>& dynamic) {
  if (dynamic.size() != echoes_) throw std::invalid_argument("a label for each echo of the last scan is needed");
  std::size_t kept = 0;
  for (std::size_t i = 0; i < to_keep_.size(); ++i) {
    if (dynamic[for_map_[i]] == 0) to_keep_[kept++] = to_keep_[i];
  }
  to_keep_.resize(kept);
}

void LidarOdometry::keep() {
  for (const Eigen::Vector3f& echo : to_keep_) map_.add(last_.odom_from_sensor * echo.cast<double>());
  to_keep_.clear();
}

}  // namespace donex
