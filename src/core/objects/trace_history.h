// Where the objects of the last scans were.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "core/objects/segment.h"

namespace donex {

/// Where an object was in an earlier scan, odometry frame [m].
struct Trace {
  /// Echoes of an object that are kept, at most.
  static constexpr std::size_t kMostPoints = 48;

  double stamp = 0.0;                                                             ///< [s]
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero();  ///< of its box
  Eigen::Vector3d seen_from = Eigen::Vector3d::Zero();                            ///< where the sensor was
  std::array<Eigen::Vector3d, kMostPoints> points;                                ///< some of its echoes
  std::size_t count = 0;

  Eigen::Vector3d center() const { return 0.5 * (low + high); }
  std::size_t size() const { return count; }
  const Eigen::Vector3d* begin() const { return points.data(); }
  const Eigen::Vector3d* end() const { return points.data() + count; }

  /// Moves all of it; the box as its centre moves.
  void move(const Eigen::Isometry3d& by);
};

/// Calls visit(echo in the odometry frame [m]) for `at_most` of the segment's echoes, spread over all of them.
template <class Visit>
void visitSome(const JudgedScan& scan, const Segment& segment, std::size_t at_most, Visit&& visit) {
  const std::size_t stride = segment.echoes.size() / at_most + 1;
  for (std::size_t i = 0; i < segment.echoes.size(); i += stride) {
    visit(Eigen::Vector3d(scan.odom_from_points * scan.points[segment.echoes[i]].cast<double>()));
  }
}

/// An object leaves one trace a scan, chained to the one before. A scan's traces lie together and are forgotten
/// together.
class TraceHistory {
 public:
  struct Id {
    std::uint32_t sheet = 0;  ///< number of the scan, from 1; 0: no trace
    std::uint32_t entry = 0;
  };

  /// Traces are asked for up to `look_back` [s] before the present scan, of objects that leave one every `longest_gap`
  /// [s] or every scan.
  TraceHistory(double look_back, double longest_gap) : look_back_(look_back), longest_gap_(longest_gap) {}

  /// The next scan [s]: forgets what will not be asked for any more. Stamps grow.
  void begin(double stamp);

  /// The segment's trace in the present scan; `before`: the same object's last one.
  Id leave(const JudgedScan& scan, const Segment& segment, Id before);

  /// True where the object whose last trace is `latest` left one at `stamp` [s] or earlier; the last of these.
  bool find(Id latest, double stamp, Trace& trace) const;

  void reset();
  std::size_t memoryBytes() const;

 private:
  struct Entry {
    Eigen::Vector3d low, high;
    std::uint32_t first, points;
    Id before;
  };
  struct Sheet {
    double stamp = 0.0;
    Eigen::Vector3d seen_from = Eigen::Vector3d::Zero();
    std::vector<Entry> entries;
    std::vector<Eigen::Vector3d> points;
  };

  void forget(double until);

  double look_back_, longest_gap_;  ///< [s]
  std::uint32_t oldest_ = 1;        ///< number of the first sheet
  std::vector<Sheet> sheets_;       ///< oldest first
  std::vector<Sheet> spares_;       ///< storage for the next ones
};

}  // namespace donex
