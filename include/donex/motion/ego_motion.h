// Where the vehicle was at any moment of the last seconds, from odometry that arrives in its own rhythm.
#pragma once

#include <cstddef>
#include <deque>

#include "donex/motion/rigid_motion.h"

namespace donex {

/// One odometry message.
struct OdometrySample {
  double stamp = 0.0;  ///< [s]
  Eigen::Isometry3d odom_from_base = Eigen::Isometry3d::Identity();
  Twist twist;  ///< of the base, in base axes
};

/// What became of a sample.
enum class AddResult {
  kAccepted,     ///< kept, in its place by time (also when it arrived late)
  kDuplicate,    ///< a sample with this stamp is there already: the first one stays
  kTooOld,       ///< late, and older than everything kept: ignored
  kTimeRanBack,  ///< older than the newest by more than the allowed disorder: ignored; the caller resets
  kTrackLost,    ///< twist only: the motion since the last sample is unknown; started anew with this one
  kNonFinite,    ///< ignored
};

/// Bounded memory of ego motion. Not thread-safe.
class EgoMotion {
 public:
  enum class Source {
    kPose,   ///< the samples' poses, interpolated
    kTwist,  ///< the samples' velocities, integrated (the paper's way); the first pose is the identity
  };

  struct Options {
    Source source = Source::kPose;
    double max_extrapolation = 0.02;  ///< beyond the newest sample [s]
    double max_gap = 1.0;             ///< between neighbours that are interpolated [s]
    double max_disorder = 0.5;        ///< a late sample may be this much older than the newest [s]
    double max_age = 10.0;            ///< samples older than the newest by more are forgotten [s]
    std::size_t max_samples = 10000;  ///< at least 2; the oldest are forgotten beyond
  };

  EgoMotion() = default;
  explicit EgoMotion(const Options& options) : options_(options) {}

  /// Only what the source uses has to be finite: the pose, or the twist.
  AddResult add(const OdometrySample& sample);

  /// odom_from_base at `stamp` [s]. Exactly the sample's pose at a sample's stamp; else between the two
  /// neighbours; else continued beyond the newest by at most max_extrapolation (by its twist, or as the
  /// two newest poses moved); else the reason.
  MotionResult<Eigen::Isometry3d> poseAt(double stamp) const;

  void reset() { samples_.clear(); }
  std::size_t size() const { return samples_.size(); }
  bool empty() const { return samples_.empty(); }
  /// Stamps of the ends [s]; only with samples.
  double oldestStamp() const { return samples_.front().stamp; }
  double newestStamp() const { return samples_.back().stamp; }

 private:
  using Samples = std::deque<OdometrySample>;  // sorted by stamp, no two alike

  bool usesTwist() const { return options_.source == Source::kTwist; }
  AddResult insert(OdometrySample sample);
  void chainFrom(std::size_t first);
  void forget();
  Eigen::Isometry3d between(const OdometrySample& before, const OdometrySample& after, double stamp) const;
  MotionResult<Eigen::Isometry3d> beyondNewest(double stamp) const;

  Options options_;
  Samples samples_;
};

}  // namespace donex
