// What the present scan says of the place where an object was (algorithm: "Proofs of motion").
#pragma once

#include <array>

#include <Eigen/Geometry>

#include "core/objects/segment_rules.h"
#include "core/objects/trace_history.h"
#include "core/sight/sight_history.h"

namespace donex {

struct MotionTestOptions {
  /// What tells that an object has moved.
  struct Step {
    double shift;   ///< that its shape must have moved [m]
    double margin;  ///< that its former place must be clear by [m]
  };

  int least_left = 3;             ///< points of a trace that must be free now before its place counts as left
  std::size_t least_points = 5;   ///< of a trace, fewer have no shape
  double still_share = 0.4;       ///< of the trace may lie near a surface
  double fit_distance = 0.25;     ///< between a point and its counterpart [m]
  double fit_share = 0.6;         ///< of the trace must have one
  int fit_rounds = 3;             ///< of shifting towards the counterparts; the last one only counts
  std::size_t many_echoes = 200;  ///< what so many describe is placed better: smaller shifts count
  Step step{0.4, 0.25}, step_of_many{0.3, 0.2};  ///< shift and margin [m]
  double stands_below = 1.2;                     ///< what begins lower may stand behind a fence or a parked car [m]
  double beneath_margin = 0.5;                   ///< so near is a surface that lies beneath [m]
  std::size_t points_beneath = 16;               ///< that are looked at

  /// What tells that an object stands elsewhere than it did.
  struct Displacement {
    std::size_t least_echoes = 70, least_points = 10;  ///< of the object, and of its trace: it is described well
    double least = 0.12;                               ///< shift, where the world's is known [m]
    double least_unknown = 0.3;                        ///< and where it is not [m]
    double most = 1.5;                                 ///< farther away it is something else [m]
    double ends_differ = 0.65;                         ///< of the shift: by how much those of its two ends may differ
    double ends_noise = 0.15;                          ///< and by as much in any case [m]
    double surface = 0.15;                             ///< so near to a point its surface is [m]
    double telling_share = 0.15;                       ///< of the trace must fit only where it is now
    double contrary_share = 0.1;                       ///< of those may fit only where it was
    double flat = 0.15;                                ///< height by length: what is flatter is a patch of ground
    double round = 0.5;                                ///< radius of what shows another side from another place [m]
  } displacement;
};

/// The line of sight's own history: what stood there has left, or stands there still, or is not known.
struct FormerPlace {
  int left = 0;   ///< points of the trace that are free now
  int still = 0;  ///< points where a surface is still
};

/// The present scan, asked for former places.
class MotionTests {
 public:
  /// `now`: what the present scan sees, asked in its points. The scan and the options outlive this.
  MotionTests(const JudgedScan& scan, const ScanSight& now, const MotionTestOptions& options);

  /// Read carefully: of a trace whose place is hidden now nothing is known.
  FormerPlace lookBack(const Trace& trace) const;

  /// True where the segment fits the shape of the trace at another place, and is gone from the old one.
  /// Slower objects than lookBack() sees, and objects behind fences, where careful sight knows nothing.
  bool hasMoved(const Trace& trace, const Segment& segment) const;

  /// True where many points of the trace fit what is seen now only where the segment has gone, and hardly any only
  /// where it was. Asks nothing of what it slides along or leaves behind, so it tells motions of a hand's breadth.
  /// `world_is_placed`: how the world seems to have shifted is known, and taken from the trace.
  bool isDisplaced(const Trace& trace, const Segment& segment, bool world_is_placed) const;

  /// True where the segment begins high above ground and what lies beneath is seen: nothing holds it there that moves.
  bool hangs(const Segment& segment) const;

 private:
  bool hasLeft(const Trace& trace, double margin) const;
  bool fitsElsewhere(const Trace& trace, const Segment& segment, double least_shift) const;
  double seemsShifted(const Trace& trace, const Segment& segment) const;

  /// A point of a trace in the scan's points [m], and what is seen there.
  struct Former {
    Eigen::Vector3f point;
    SightImage::Sight sight;
  };
  /// Those of which anything is known.
  struct Formers {
    std::array<Former, Trace::kMostPoints> all;
    std::size_t count = 0, on_surface = 0;
  };
  Formers formersOf(const Trace& trace) const;
  SightImage::Sight sightOf(const Eigen::Vector3f& point, double margin) const {
    return now_.ofNearestBeam(point, static_cast<float>(margin), rows_beside_);
  }

  /// Points of a trace, by where alone they fit what is seen now.
  struct Fits {
    double shift = 0.0;  ///< [m]
    int there = 0, here = 0;
  };
  Fits fitsAlone(const Formers& formers, const Eigen::Vector2d& shift) const;

  const JudgedScan& scan_;
  const MotionTestOptions& options_;
  ScanSight now_;
  Eigen::Isometry3d points_from_odom_;
  int rows_beside_;  ///< of the sight image, to the beam closest to a place
};

}  // namespace donex
