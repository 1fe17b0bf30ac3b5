// What the present scan says of the place where an object was (algorithm: "Proofs of motion").
#pragma once

#include <Eigen/Geometry>

#include "core/objects/segment.h"
#include "core/objects/trace_history.h"
#include "core/sight/sight_history.h"

namespace donex {

constexpr int kLeastLeft = 3;  ///< points of a trace that must be free now before its place counts as left

/// The line of sight's own history: what stood there has left, or stands there still, or is not known.
struct FormerPlace {
  int left = 0;   ///< points of the trace that are free now
  int still = 0;  ///< points where a surface is still
};

/// The present scan, asked for former places.
class MotionTests {
 public:
  /// `now`: what the present scan sees, asked in its points. The scan outlives this.
  MotionTests(const JudgedScan& scan, const ScanSight& now);

  /// Read carefully: of a trace whose place is hidden now nothing is known.
  FormerPlace lookBack(const Trace& trace) const;

  /// True where the segment fits the shape of the trace at another place, and is gone from the old one.
  /// Slower objects than lookBack() sees, and objects behind fences, where careful sight knows nothing.
  bool hasMoved(const Trace& trace, const Segment& segment) const;

  /// True where the segment begins high above ground and what lies beneath is seen: nothing holds it there that moves.
  bool hangs(const Segment& segment) const;

 private:
  bool hasLeft(const Trace& trace, float margin) const;
  bool fitsElsewhere(const Trace& trace, const Segment& segment, double least_shift) const;

  const JudgedScan& scan_;
  ScanSight now_;
  Eigen::Isometry3d points_from_odom_;
};

}  // namespace donex
