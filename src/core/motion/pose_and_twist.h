// Poses against velocities of the same odometry messages: an odometry that fills only one of both is told at once.
#pragma once

#include "donex/motion/ego_motion.h"

namespace donex {

class PoseAndTwist {
 public:
  struct Options {
    double way = 1.0;          ///< by the velocities, without which a pose that stays may be right [m]
    double time = 0.3;         ///< some publish a pose several times [s]
    double largest_gap = 1.0;  ///< between messages, over which nothing is integrated [s]
  };

  PoseAndTwist() = default;
  explicit PoseAndTwist(const Options& options) : options_(options) {}

  /// Whether the pose has stayed the same, to the last bit, while the velocities led away. Samples that are not later
  /// than the one before are passed over.
  bool standsStill(const OdometrySample& sample);

  /// Since when and how far, of the sample told last.
  double time() const { return time_; }  ///< [s]
  double way() const { return way_; }    ///< [m]

  void reset() { has_sample_ = false; }

 private:
  Options options_;
  bool has_sample_ = false;
  OdometrySample last_;
  double way_ = 0.0, time_ = 0.0;
};

}  // namespace donex
