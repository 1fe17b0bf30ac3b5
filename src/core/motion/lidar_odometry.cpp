#include "core/motion/lidar_odometry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "donex/motion/deskew.h"
#include "donex/motion/rigid_motion.h"

namespace donex {
namespace {

constexpr double kLever = 15.0;  // [m] where a turn moves echoes

double turnOf(const Eigen::Isometry3d& motion) {
  return std::abs(Eigen::AngleAxisd(Eigen::Matrix3d(motion.linear())).angle());
}

double shareFitting(const Registration& registration) {
  return static_cast<double>(registration.fitting) /
         static_cast<double>(std::max<std::size_t>(1, registration.matched));
}

/// On and on as in this step; it ends at time 0.
EgoMotion steadyMotion(const Eigen::Isometry3d& step, double time) {
  EgoMotion::Options options;
  options.max_gap = options.max_extrapolation = std::numeric_limits<double>::max();
  EgoMotion motion(options);
  OdometrySample sample;
  sample.stamp = -time;
  sample.odom_from_base = step.inverse();
  motion.add(sample);
  sample.stamp = 0.0;
  sample.odom_from_base.setIdentity();
  motion.add(sample);
  return motion;
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

RegistrationOptions LidarOdometry::registrationOfScans() {
  RegistrationOptions options;
  options.least_information = 0.001;  // open country holds no more; slides() asks for what that lets pass
  options.counts_ground = false;
  return options;
}

Eigen::Isometry3d LidarOdometry::Step::during(double duration) const {
  if (!isKnown()) return Eigen::Isometry3d::Identity();
  return interpolate(Eigen::Isometry3d::Identity(), motion, duration / time);
}

LidarOdometry::LidarOdometry(const Options& options)
    : options_(options), map_(options.map), registration_(options.registration), selection_(options.selection) {
  reset();
}

void LidarOdometry::reset() {
  map_.clear();
  last_ = TrackedScan();
  step_ = Step();
  squared_error_ = options_.first_gate * options_.first_gate / 9.0;
  usual_fitting_ = 0.0;
  lost_since_.reset();
  has_track_ = is_anchored_ = false;
  doubt_ = 0;
  determined_at_ = 0.0;
  to_keep_.clear();
}

std::size_t LidarOdometry::memoryBytes() const {
  return map_.memoryBytes() + selection_.memoryBytes() +
         (source_.capacity() + to_keep_.capacity()) * sizeof(Eigen::Vector3f) + times_.capacity() * sizeof(float);
}

const TrackedScan& LidarOdometry::locate(double stamp, const std::vector<Eigen::Vector3f>& echoes,
                                         const std::vector<float>& times) {
  if (!times.empty() && times.size() != echoes.size()) throw std::invalid_argument("a time for each echo is needed");
  keep();
  selection_.select(echoes);
  const Cloud cloud{echoes, times};
  readTimes(stamp, times);
  take(cloud, selection_.toRegister(), step_, source_);
  if (has_track_) {
    follow(cloud);
  } else if (source_.size() >= options_.least_echoes) {
    startTrack(last_.moment, last_.odom_from_sensor);
  } else {
    last_.status = TrackingStatus::kLost;
  }
  to_keep_.clear();
  if (last_.status != TrackingStatus::kLost) take(cloud, selection_.forMap(), step_, to_keep_);
  return last_;
}

void LidarOdometry::readTimes(double stamp, const std::vector<float>& times) {
  first_ = last_time_ = 0.0;
  bool is_first = true;
  for (const std::uint32_t i : selection_.forMap()) {
    if (times.empty() || !std::isfinite(times[i])) continue;
    const auto time = static_cast<double>(times[i]);
    first_ = is_first ? time : std::min(first_, time);
    last_time_ = is_first ? time : std::max(last_time_, time);
    is_first = false;
  }
  last_.moment = stamp + 0.5 * (first_ + last_time_);
}

/// The echoes at these indices, where the sensor would have seen them in the middle of the scan.
void LidarOdometry::take(const Cloud& cloud, const std::vector<std::uint32_t>& from, const Step& step,
                         std::vector<Eigen::Vector3f>& taken) {
  const auto middle = static_cast<float>(0.5 * (first_ + last_time_));
  taken.clear();
  times_.clear();
  for (const std::uint32_t i : from) {
    taken.push_back(cloud.echoes[i]);
    if (!cloud.times.empty()) times_.push_back(cloud.times[i] - middle);
  }
  const bool is_distorted = !times_.empty() && step.isKnown();
  if (is_distorted) deskew(steadyMotion(step.motion, step.time), 0.0, Eigen::Isometry3d::Identity(), times_, taken);
}

void LidarOdometry::follow(const Cloud& cloud) {
  const double stamp = last_.moment;
  const double elapsed = std::max(0.0, stamp - last_stamp_);
  const Eigen::Isometry3d prediction = predicted(stamp);
  if (source_.size() < options_.least_echoes) return lose(prediction, stamp);
  map_.moveTo(prediction.translation());
  Registration registration = registered(prediction, elapsed);
  correct(cloud, elapsed, registration);
  distrust(prediction, registration);
  if (isSound(registration, prediction, elapsed)) {
    accept(registration, prediction, stamp);
  } else {
    lose(prediction, stamp);
  }
}

/// Where the velocity is another one than before, it has moved the echoes to the wrong places.
void LidarOdometry::correct(const Cloud& cloud, double elapsed, Registration& registration) {
  const double reach = 0.5 * (last_time_ - first_);
  Step step = step_;
  for (int i = 0; i < options_.most_corrections; ++i) {
    if (!step_.isKnown() || !(elapsed > 0.0) || !(reach > 0.0) || registration.undetermined > 0) return;
    const Step found{last_.odom_from_sensor.inverse() * registration.map_from_sensor, elapsed};
    const Eigen::Isometry3d change = found.during(reach).inverse() * step.during(reach);
    if (change.translation().norm() + kLever * turnOf(change) < options_.least_correction) return;
    step = found;
    take(cloud, selection_.toRegister(), step, source_);
    registration = registration_.align(map_, source_, registration.map_from_sensor, options_.least_gate);
  }
}

Eigen::Isometry3d LidarOdometry::predicted(double stamp) const {
  if (!step_.isKnown()) return last_.odom_from_sensor;
  const double elapsed = std::min(std::max(0.0, stamp - last_stamp_), options_.longest_prediction);
  return last_.odom_from_sensor * step_.during(elapsed);
}

/// From the prediction, and where that does not end well from farther away.
Registration LidarOdometry::registered(const Eigen::Isometry3d& prediction, double elapsed) {
  const double gate = std::min(std::max(3.0 * std::sqrt(squared_error_), options_.least_gate), options_.first_gate);
  const Registration first = registration_.align(map_, source_, prediction, gate);
  const bool has_velocity = step_.isKnown() && !lost_since_;
  if (has_velocity && isUsual(first) && isSound(first, prediction, elapsed)) return first;
  const double reach =
      has_velocity ? options_.search_step : std::min(options_.search_reach, options_.search_speed * elapsed);
  const Registration second = registration_.align(map_, source_, searched(prediction, reach), options_.search_step);
  // Along a tunnel everything fits, and the prediction tells more.
  const bool is_open = second.undetermined > 0;
  const double fitness = fitnessAt(first.map_from_sensor, 1);
  const double least = std::max(options_.better_fitness * fitness, fitness + options_.least_better);
  const bool is_better = fitnessAt(second.map_from_sensor, 1) > least;
  return is_better && !is_open ? second : first;
}

bool LidarOdometry::isUsual(const Registration& registration) const {
  return registration.undetermined == 0 && shareFitting(registration) > options_.usual_share * usual_fitting_;
}

/// What holds a scan that slides is not trusted, nor is the scan after it that happens not to. One that matches nothing
/// tells nothing of this either: two sensors that look different ways take turns.
void LidarOdometry::distrust(const Eigen::Isometry3d& prediction, Registration& registration) {
  if (registration.undetermined == 6) return;
  doubt_ = slides(registration) ? options_.scans_of_doubt + 1 : std::max(0, doubt_ - 1);
  if (doubt_ > 0 && registration.undetermined == 0) leaveOpen(prediction, registration);
}

/// Whether a scan fits about as well all along a direction on the ground, as between parallel barriers.
bool LidarOdometry::slides(const Registration& registration) {
  constexpr std::size_t kEnoughToSlide = 1000;  // echoes
  constexpr double kSteep = 0.7;                // of the unit vector's height: no vehicle slides up
  if (std::abs(registration.weakest.z()) > kSteep) return false;
  const std::size_t stride = std::max<std::size_t>(1, source_.size() / kEnoughToSlide);
  const Eigen::Isometry3d& pose = registration.map_from_sensor;
  double ahead = 0.0, behind = 0.0;
  for (const double distance : options_.slide_distances) {
    const Eigen::Vector3d slide = distance * registration.weakest;
    ahead += fitnessAt(Eigen::Translation3d(slide) * pose, stride);
    behind += fitnessAt(Eigen::Translation3d(-slide) * pose, stride);
  }
  const double beside = std::max(ahead, behind) / static_cast<double>(options_.slide_distances.size());
  return beside >= options_.slide_fitness * fitnessAt(pose, stride);
}

/// The least determined direction is left to the prediction.
void LidarOdometry::leaveOpen(const Eigen::Isometry3d& prediction, Registration& registration) const {
  const Eigen::Vector3d to_prediction = prediction.translation() - registration.map_from_sensor.translation();
  registration.map_from_sensor.pretranslate(registration.weakest * registration.weakest.dot(to_prediction));
  registration.undetermined = 1;
}

double LidarOdometry::fitnessAt(const Eigen::Isometry3d& pose, std::size_t stride) {
  constexpr double kFitKernel = 0.15;  // [m]
  return registration_.fitness(map_, source_, pose, kFitKernel, stride);
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
  const bool has_velocity = step_.isKnown();
  const double time = std::max(elapsed, 0.05);  // neither at rest is a scan placed exactly
  const double most =
      has_velocity ? options_.most_acceleration * time * std::max(time, step_.time) : options_.search_speed * time;
  return change.translation().norm() <= most + 0.1 && turnOf(change) <= options_.most_turn * std::max(1.0, time / 0.1);
}

void LidarOdometry::startTrack(double stamp, const Eigen::Isometry3d& pose) {
  reset();
  has_track_ = true;
  last_.moment = stamp;
  last_.odom_from_sensor = pose;
  last_stamp_ = stamp;
  startMap();
}

void LidarOdometry::startMap() {
  map_.clear();
  map_.moveTo(last_.odom_from_sensor.translation());
}

void LidarOdometry::accept(const Registration& registration, const Eigen::Isometry3d& prediction, double stamp) {
  const Eigen::Isometry3d before = last_.odom_from_sensor;
  const bool knew_velocity = step_.isKnown();
  last_.odom_from_sensor = orthonormalised(registration.map_from_sensor);
  last_.is_new_track = false;
  last_.undetermined = registration.undetermined;
  last_.least_information = registration.least_information;
  last_.fitting = shareFitting(registration);
  usual_fitting_ += 0.1 * (last_.fitting - usual_fitting_);
  last_.status = registration.undetermined > 0 ? TrackingStatus::kDegenerate
                 : knew_velocity               ? TrackingStatus::kTracking
                                               : TrackingStatus::kStarting;
  lost_since_.reset();
  const bool is_open = registration.undetermined > 0;
  if (!is_open) determined_at_ = stamp;
  is_anchored_ = !is_open || (is_anchored_ && stamp - determined_at_ < options_.longest_prediction);
  if (stamp > last_stamp_) {
    step_ = {before.inverse() * last_.odom_from_sensor, stamp - last_stamp_};
    last_stamp_ = stamp;
  }
  if (knew_velocity) {
    adaptGate(prediction);
  } else if (last_time_ > first_) {
    startMap();  // the first scan has not been straightened: no velocity was known
  }
}

void LidarOdometry::adaptGate(const Eigen::Isometry3d& prediction) {
  constexpr double kFading = 0.8;
  const Eigen::Isometry3d change = prediction.inverse() * last_.odom_from_sensor;
  const double error = change.translation().norm() + kLever * turnOf(change);
  squared_error_ = std::max(kFading * squared_error_ + (1.0 - kFading) * error * error, 0.0);
}

void LidarOdometry::lose(const Eigen::Isometry3d& prediction, double stamp) {
  const bool may_start = source_.size() >= options_.least_echoes;
  if (!lost_since_) lost_since_ = stamp;
  if (stamp - *lost_since_ >= options_.new_track_after && may_start) return startTrack(stamp, prediction);
  last_.odom_from_sensor = prediction;
  last_.status = TrackingStatus::kLost;
  last_.is_new_track = false;
  last_.undetermined = 6;
  last_.fitting = last_.least_information = 0.0;
  last_stamp_ = std::max(last_stamp_, stamp);
  if (stamp - *lost_since_ + step_.time > options_.longest_prediction) step_.motion.setIdentity();
}

void LidarOdometry::learn(const std::vector<std::uint8_t>& dynamic) { selection_.leaveOutMoving(dynamic, to_keep_); }

void LidarOdometry::keep() {
  // Scans that were put behind one another by a guess of the velocity make walls that nobody has built.
  if (!is_anchored_ && !to_keep_.empty()) startMap();
  for (const Eigen::Vector3f& echo : to_keep_) map_.add(last_.odom_from_sensor * echo.cast<double>());
  to_keep_.clear();
}

}  // namespace donex
