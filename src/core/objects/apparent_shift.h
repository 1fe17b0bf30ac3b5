// How the world seems to have shifted since an earlier scan, which is what the poses got wrong (algorithm: "Proofs of
// motion").
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "core/objects/trace_history.h"

namespace donex {

struct ApparentShiftOptions {
  double most = 0.5;                  ///< of the end of a box; more is a motion, or another view of it [m]
  double has_stood = 0.05;            ///< an end that shifts with the world to within this has stood [m]
  double widest = 0.3;                ///< the same when rounds begin: nothing is known of the shift yet [m]
  double narrowing = 0.7;             ///< of that from round to round
  int rounds = 10;                    ///< of weighing; the last ones are as narrow as it gets
  std::size_t least_ends = 24;        ///< that must be seen in both scans, each coordinate by itself
  double least_standing = 1.0 / 3.0;  ///< share of the ends that must have stood
  double least_gain = 2.0;  ///< so many times its own scatter more of them must stand with a shift than with none
};

/// Most of what a scan sees stands. So the shift that the ends of most boxes agree on, level and about the vertical, is
/// that of the poses; what moves shifts otherwise.
class ApparentShift {
 public:
  explicit ApparentShift(const ApparentShiftOptions& options = {}) : options_(options) {}

  /// Forgets everything; turns are about `sensor`, odometry frame [m].
  void begin(const Eigen::Vector3d& sensor);
  /// The same object in the earlier scan and now.
  void add(const Trace& then, const Segment& now);
  /// From what was added; identity where that agrees on nothing.
  void solve();

  /// Whether enough agreed on a shift, or on none.
  bool isKnown() const { return is_known_; }
  /// From where things that stand were in the odometry's frame to where they seem to be now.
  const Eigen::Isometry3d& nowFromThen() const { return now_from_then_; }

  std::size_t memoryBytes() const { return ends_.capacity() * sizeof(End); }

 private:
  /// One coordinate of an end of a box: by how much it shifts, and what it would shift by with the world: `slope` times
  /// (x [m], y [m], yaw [rad]).
  struct End {
    Eigen::Vector3d slope;
    double shift;
  };

  std::size_t standing(const Eigen::Vector3d& world) const;
  Eigen::Vector3d reweighed(const Eigen::Vector3d& world, double scale) const;

  ApparentShiftOptions options_;
  Eigen::Vector2d sensor_ = Eigen::Vector2d::Zero();
  std::vector<End> ends_;
  bool is_known_ = false;
  Eigen::Isometry3d now_from_then_ = Eigen::Isometry3d::Identity();
};

}  // namespace donex
