#include "core/motion/deskew_choice.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "donex/motion/deskew.h"

namespace donex {
namespace {

/// Two scans fill hardly more; far less than a map of the surroundings.
GaussianMap::Options smallMap() {
  GaussianMap::Options options;
  options.most_voxels = 1U << 14U;
  return options;
}

EgoMotion::Options trackOptions() {
  EgoMotion::Options options;
  options.max_age = 4.0;
  options.max_gap = 0.35;  // lost scans; the motion between is told by its ends alone
  return options;
}

}  // namespace

DeskewChoice::DeskewChoice(std::vector<TimeReading> readings, const Options& options)
    : readings_(std::move(readings)), options_(options), registration_(RegistrationOptions()), track_(trackOptions()) {}

void DeskewChoice::reset() {
  track_.reset();
  taken_ = 0;
  next_ = 0.0;
}

bool DeskewChoice::wants(double stamp) const {
  if (taken_ == 0) return stamp >= next_;
  return taken_ == 1 && stamp >= before_.stamp + options_.apart;
}

void DeskewChoice::take(double stamp, const std::vector<Eigen::Vector3f>& echoes, const std::vector<float>& times) {
  if (!wants(stamp) || echoes.size() != times.size()) return;
  Sample& sample = taken_ == 0 ? before_ : after_;
  sample.stamp = stamp;
  sample.echoes.clear();
  sample.times.clear();
  // Odd: a power of two would take the same few beams in each column.
  const std::size_t stride = (echoes.size() / options_.sampled_echoes) | 1U;
  for (std::size_t i = 0; i < echoes.size(); i += stride) {
    const float range = echoes[i].norm();
    const bool is_of_use = range > options_.nearest && range < options_.farthest;  // never with NaN
    if (!is_of_use) continue;
    sample.echoes.push_back(echoes[i]);
    sample.times.push_back(times[i]);
  }
  if (sample.times.size() < options_.least_echoes) return;
  const auto ends = std::minmax_element(sample.times.begin(), sample.times.end());
  sample.first = *ends.first;
  sample.last = *ends.second;
  ++taken_;
}

bool DeskewChoice::follow(double stamp, const Eigen::Isometry3d& odom_from_sensor) {
  OdometrySample pose;
  pose.stamp = stamp;
  pose.odom_from_base = odom_from_sensor;
  if (track_.add(pose) == AddResult::kTimeRanBack) reset();
  if (taken_ < 2) return false;
  if (!isCovered(after_)) {
    if (stamp > after_.stamp + options_.lost_after) taken_ = 0;
    return false;
  }
  taken_ = 0;
  next_ = stamp;
  const bool is_of_use = isCovered(before_) && isMoving(after_);
  return is_of_use && compare() && choose();
}

/// Whether the track reaches over all that any reading makes of the times.
bool DeskewChoice::isCovered(const Sample& sample) const {
  double first = 0.0, last = 0.0;
  for (const TimeReading& reading : readings_) {
    const double span = sample.last - sample.first;
    for (const double time : {reading.scaled(sample.first, span), reading.scaled(sample.last, span)}) {
      first = std::min(first, time);
      last = std::max(last, time);
    }
  }
  return track_.poseAt(sample.stamp + first) && track_.poseAt(sample.stamp + last);
}

bool DeskewChoice::isMoving(const Sample& sample) const {
  const double span = sample.last - sample.first;
  const auto begin = track_.poseAt(sample.stamp - 0.5 * span), end = track_.poseAt(sample.stamp + 0.5 * span);
  if (!begin || !end) return false;
  const Eigen::Isometry3d motion = begin->inverse() * *end;
  const double turn = Eigen::AngleAxisd(Eigen::Matrix3d(motion.linear())).angle();
  return turn >= options_.least_turn || motion.translation().norm() >= options_.least_way;
}

bool DeskewChoice::place(const Sample& sample, const TimeReading& reading, std::vector<Eigen::Vector3f>& echoes,
                         Eigen::Isometry3d& odom_from_sensor) const {
  const auto pose = track_.poseAt(sample.stamp);
  if (!pose) return false;
  odom_from_sensor = *pose;
  echoes = sample.echoes;
  if (reading.undoesNothing()) return true;
  std::vector<float> times;
  const double span = sample.last - sample.first;
  for (const float time : sample.times) {
    times.push_back(static_cast<float>(reading(static_cast<double>(time), span)));
  }
  return deskew(track_, sample.stamp, Eigen::Isometry3d::Identity(), times, echoes) == MotionFault::kNone;
}

bool DeskewChoice::compare() {
  if (!map_) map_.emplace(smallMap());
  std::vector<double> fits;
  Eigen::Isometry3d pose;
  for (const TimeReading& reading : readings_) {
    if (!place(before_, reading, straight_, pose)) return false;
    map_->clear();
    for (const Eigen::Vector3f& echo : straight_) map_->add(pose * echo.cast<double>());
    if (!place(after_, reading, straight_, pose)) return false;
    fits.push_back(registration_.fitness(*map_, straight_, pose, options_.kernel, options_.asked));
  }
  ++pairs_;
  fits_.push_back(std::move(fits));
  if (fits_.size() > options_.window) fits_.pop_front();
  return true;
}

std::vector<double> DeskewChoice::fits() const {
  std::vector<double> means(readings_.size(), 0.0);
  for (const std::vector<double>& fits : fits_) {
    for (std::size_t i = 0; i < fits.size(); ++i) means[i] += fits[i] / static_cast<double>(fits_.size());
  }
  return means;
}

/// On average, and in nearly every pair.
bool DeskewChoice::fitsBetter(std::size_t reading, std::size_t other) const {
  const std::vector<double> means = fits();
  const auto lost = std::count_if(fits_.begin(), fits_.end(), [&](const std::vector<double>& fits) {
    return fits[reading] <= (1.0 - options_.lost) * fits[other];
  });
  return means[reading] > (1.0 + options_.least_gain) * means[other] &&
         static_cast<double>(lost) <= options_.most_lost * static_cast<double>(fits_.size());
}

bool DeskewChoice::choose() {
  if (pairs_ >= options_.many) next_ += options_.slow_period;
  if (fits_.size() < options_.least_pairs) return false;
  const std::vector<double> means = fits();
  const auto best = static_cast<std::size_t>(std::max_element(means.begin(), means.end()) - means.begin());
  if (best == chosen_) {
    bool is_clear = true;
    for (std::size_t i = 0; i < readings_.size(); ++i) is_clear = is_clear && (i == best || fitsBetter(best, i));
    if (is_clear && pairs_ < options_.many) next_ += options_.slow_period;
    return false;
  }
  if (!fitsBetter(best, chosen_)) return false;
  gain_ = means[best] / means[chosen_] - 1.0;
  chosen_ = best;
  fits_.clear();
  pairs_ = 0;
  return true;
}

}  // namespace donex
