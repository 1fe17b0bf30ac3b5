// Segments followed over time: does this object move? (algorithm: "Tracks", "Proofs of motion")
#pragma once

#include <limits>
#include <vector>

#include "core/objects/motion_tests.h"
#include "donex/object.h"

namespace donex {

/// Follows segments from scan to scan. An object moves
///  - where enough of its echoes are new: its front comes into space that was free.
/// With ObjectConfig::motion also
///  - where its former place is now seen free: its rear has receded. This finds a vehicle ahead at the
///    ego vehicle's own speed, whose front nobody sees and whose rear only ever enters its own shadow;
///  - where a little of both is true: the ends of a long vehicle that passes by;
///  - where its former shape fits it at another place, and is gone from the old one.
class ObjectTracker {
 public:
  explicit ObjectTracker(const ObjectConfig& config);

  /// Where the moving objects should be at `stamp` [s].
  void predict(double stamp, Predictions& predictions) const;

  /// Follows the segments of a scan and decides about each. `predictions` are those for the scan; `now`: what the scan
  /// sees, asked in its points.
  void update(const JudgedScan& scan, const Segments& segments, const Predictions& predictions, const ScanSight& now,
              Verdicts& verdicts);

  /// Objects of the last scan that move, or moved since they are followed.
  const std::vector<Object>& objects() const { return objects_; }

  void reset();
  std::size_t memoryBytes() const;

 private:
  static constexpr double kNever = -std::numeric_limits<double>::infinity();

  struct Track {
    std::uint32_t id = 0;
    Eigen::Vector3d center, extent, velocity = Eigen::Vector3d::Zero();
    Eigen::Vector3d full_extent;  ///< as seen when less of it was hidden
    double first_seen = 0.0, last_seen = 0.0;
    double last_motion = kNever, last_moved_whole = kNever;
    int receding_scans = 0, advancing_scans = 0, moving_scans = 0;  ///< in a row
    bool dynamic = false, ever_dynamic = false;
    bool is_found = false;   ///< in the present scan
    TraceHistory::Id trace;  ///< its last one

    Eigen::Vector3d centerAt(double stamp) const { return center + velocity * (stamp - last_seen); }
  };
  struct Pair {
    double distance;
    std::size_t track, segment;
  };

  void match(double stamp, const Segments& segments);
  Track& trackOf(std::size_t segment_index, double stamp, const Segment& segment);
  static void follow(Track& track, double stamp, const Segment& segment);
  void testMotion(Track& track, const MotionTests& tests, double stamp, const Segment& segment) const;
  Proof proofOf(const Track& track, const MotionTests& tests, double stamp, const Segment& segment) const;
  Verdict decide(Track& track, const MotionTests& tests, double stamp, const Segment& segment) const;
  static void complete(const Segments& segments, const Predictions& predictions, Verdicts& verdicts);
  void describe(const Track& track, Proof proof, const JudgedScan& scan, const Segment& segment);

  ObjectConfig config_;
  Eigen::Vector3d sensor_ = Eigen::Vector3d::Zero();  ///< of the present scan, odometry frame [m]
  TraceHistory traces_;
  std::vector<Track> tracks_;
  std::vector<Pair> pairs_;
  std::vector<int> track_of_;  ///< by segment, -1 where it is followed for the first time
  std::vector<Object> objects_;
  std::uint32_t next_id_ = 1;
};

}  // namespace donex
