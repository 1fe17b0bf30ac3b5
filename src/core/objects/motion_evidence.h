// What the present scan says of the place where an object was (algorithm: "Proofs of motion").
#pragma once

#include <Eigen/Geometry>

#include "core/objects/candidate.h"
#include "core/objects/trace_history.h"
#include "core/sight/sight_history.h"

namespace donex {

constexpr int kLeastLeft = 3;  ///< points of a trace that must be free now before its place counts as left

/// The line of sight's own history: what stood there has left, or stands there still, or is not known.
struct Former {
  int left = 0;   ///< points of the trace that are free now
  int still = 0;  ///< points where a surface is still
};

/// The present scan, asked for former places.
class MotionEvidence {
 public:
  /// `history` has the present scan as its newest and is asked in its points; both outlive this.
  MotionEvidence(const JudgedScan& scan, const SightHistory& history);

  /// Read carefully: of a trace whose place is hidden now nothing is known.
  Former lookBack(const Trace& trace) const;

  /// True where the candidate fits the shape of the trace at another place, and is gone from the old one.
  /// Slower things than lookBack() sees, and things behind fences, where careful sight knows nothing.
  bool hasMoved(const Trace& trace, const Candidate& candidate) const;

 private:
  bool hasLeft(const Trace& trace, float margin) const;
  bool fitsElsewhere(const Trace& trace, const Candidate& candidate, double least_shift) const;

  const JudgedScan& scan_;
  const SightHistory& history_;
  Eigen::Isometry3d points_from_odom_;
};

}  // namespace donex
