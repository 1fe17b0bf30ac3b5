#include "donex/motion/ego_motion.h"

#include <algorithm>
#include <cmath>

namespace donex {
namespace {

/// Today's stamps as double resolve 0.24 us, per-echo times as float less: nearer than this is the same time [s].
constexpr double kTimeResolution = 1e-6;

bool isEarlier(const OdometrySample& sample, double stamp) { return sample.stamp < stamp; }

/// The velocity between two samples: the mean makes the integration exact to second order.
Twist meanTwist(const OdometrySample& a, const OdometrySample& b) {
  return {0.5 * (a.twist.linear + b.twist.linear), 0.5 * (a.twist.angular + b.twist.angular)};
}

bool isFinite(const OdometrySample& sample, bool uses_twist) {
  if (!std::isfinite(sample.stamp)) return false;
  if (uses_twist) return sample.twist.linear.allFinite() && sample.twist.angular.allFinite();
  return sample.odom_from_base.matrix().allFinite();
}

}  // namespace

AddResult EgoMotion::add(const OdometrySample& sample) {
  if (!isFinite(sample, usesTwist())) return AddResult::kNonFinite;
  if (samples_.empty()) return insert(sample);

  const double lead = sample.stamp - newestStamp();
  if (lead < -options_.max_disorder) return AddResult::kTimeRanBack;
  const bool full = samples_.size() >= options_.max_samples;
  const bool would_be_forgotten = -lead > options_.max_age || (full && sample.stamp < oldestStamp());
  if (would_be_forgotten) return AddResult::kTooOld;
  if (usesTwist() && lead > options_.max_gap) {
    reset();
    insert(sample);
    return AddResult::kTrackLost;
  }
  return insert(sample);
}

AddResult EgoMotion::insert(OdometrySample sample) {
  const auto place = std::lower_bound(samples_.begin(), samples_.end(), sample.stamp, isEarlier);
  if (place != samples_.end() && place->stamp == sample.stamp) return AddResult::kDuplicate;
  if (usesTwist()) sample.odom_from_base.setIdentity();
  const auto index = static_cast<std::size_t>(place - samples_.begin());
  samples_.insert(place, sample);
  if (usesTwist()) chainFrom(index);
  forget();
  return AddResult::kAccepted;
}

/// Poses from velocities, from the sample at `first` onwards. A new oldest one is tied to the pose of its
/// successor instead, which scans may have been placed by already.
void EgoMotion::chainFrom(std::size_t first) {
  if (first == 0 && samples_.size() > 1) {
    const OdometrySample& next = samples_[1];
    const Twist twist = meanTwist(samples_[0], next);
    samples_[0].odom_from_base = next.odom_from_base * integrateTwist(twist, samples_[0].stamp - next.stamp);
    return;
  }
  for (std::size_t i = std::max<std::size_t>(first, 1); i < samples_.size(); ++i) {
    const OdometrySample& previous = samples_[i - 1];
    const double duration = samples_[i].stamp - previous.stamp;
    samples_[i].odom_from_base =
        orthonormalised(previous.odom_from_base * integrateTwist(meanTwist(previous, samples_[i]), duration));
  }
}

void EgoMotion::forget() {
  const double horizon = newestStamp() - options_.max_age;
  const std::size_t most = std::max<std::size_t>(options_.max_samples, 2);
  while (samples_.size() > most || oldestStamp() < horizon) samples_.pop_front();
}

MotionResult<Eigen::Isometry3d> EgoMotion::poseAt(double stamp) const {
  if (!std::isfinite(stamp)) return MotionFault::kNonFinite;
  if (samples_.empty()) return MotionFault::kNoSamples;
  const auto after = std::lower_bound(samples_.begin(), samples_.end(), stamp, isEarlier);
  if (after == samples_.end()) return beyondNewest(stamp);
  if (after->stamp == stamp) return after->odom_from_base;
  if (after == samples_.begin()) {
    if (after->stamp - stamp > kTimeResolution) return MotionFault::kTooOld;
    return after->odom_from_base;
  }
  const auto previous = std::prev(after);
  if (after->stamp - previous->stamp > options_.max_gap) return MotionFault::kGapTooLong;
  return between(*previous, *after, stamp);
}

Eigen::Isometry3d EgoMotion::between(const OdometrySample& before, const OdometrySample& after, double stamp) const {
  const double elapsed = stamp - before.stamp;
  if (usesTwist()) return before.odom_from_base * integrateTwist(meanTwist(before, after), elapsed);
  return interpolate(before.odom_from_base, after.odom_from_base, elapsed / (after.stamp - before.stamp));
}

MotionResult<Eigen::Isometry3d> EgoMotion::beyondNewest(double stamp) const {
  const OdometrySample& newest = samples_.back();
  const double elapsed = stamp - newest.stamp;
  if (elapsed > options_.max_extrapolation + kTimeResolution) return MotionFault::kNotYetCovered;
  if (usesTwist()) return newest.odom_from_base * integrateTwist(newest.twist, elapsed);

  if (elapsed <= kTimeResolution) return newest.odom_from_base;
  // Many odometry sources leave the twist unfilled: with poses, only two of them tell how the vehicle moves.
  if (samples_.size() < 2) return MotionFault::kNotYetCovered;
  const OdometrySample& previous = samples_[samples_.size() - 2];
  if (newest.stamp - previous.stamp > options_.max_gap) return MotionFault::kGapTooLong;
  return between(previous, newest, stamp);
}

}  // namespace donex
