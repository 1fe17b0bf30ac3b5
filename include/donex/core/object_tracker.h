// Connected echoes followed over time: is this thing moving? (algorithm section 5, step 6)
#pragma once

#include <array>
#include <deque>
#include <vector>

#include "donex/core/candidate_finder.h"
#include "donex/core/config.h"
#include "donex/core/object.h"
#include "donex/core/sight_history.h"

namespace donex {

/// Follows candidates from scan to scan. An object moves
///  - where enough of its echoes are new: its front comes into space that was free;
///  - where its former place is now seen free: its rear has receded. This finds a vehicle ahead at the
///    ego vehicle's own speed, whose front nobody sees and whose rear only ever enters its own shadow;
///  - where a little of both is true: the ends of a long vehicle that passes by.
class ObjectTracker {
 public:
  explicit ObjectTracker(const ObjectConfig& config) : config_(config) {}

  /// Decides `dynamic` of every candidate of a scan. `history` is asked in the scan's points; its newest
  /// scan is this one.
  void update(const JudgedScan& scan, const SightHistory& history, std::vector<Candidate>& candidates);

  /// Objects of the last scan that move, or moved since they are followed.
  const std::vector<Object>& objects() const { return objects_; }

  void reset();
  std::size_t memoryBytes() const;

 private:
  /// Where some of an object's echoes were.
  struct Trace {
    double stamp;
    std::vector<Eigen::Vector3d> in_odom;
  };
  struct Track {
    std::uint32_t id = 0;
    Eigen::Vector3d center, extent, velocity = Eigen::Vector3d::Zero();
    double first_seen = 0.0, last_seen = 0.0, last_motion = 0.0;
    int receding_scans = 0, advancing_scans = 0;  ///< in a row
    bool dynamic = false, ever_dynamic = false;
    std::deque<Trace> traces;
  };
  /// What the present scan sees where an object was: points of its trace.
  struct Former {
    int left = 0;   ///< free now
    int still = 0;  ///< a surface still
  };
  struct Pair {
    double distance;
    std::size_t track, candidate;
  };

  void match(double stamp, const std::vector<Candidate>& candidates);
  Track& trackOf(std::size_t candidate_index, double stamp, const Candidate& candidate);
  static void follow(Track& track, double stamp, const Candidate& candidate);
  static Former lookBack(const Track& track, double to, const Eigen::Isometry3d& points_from_odom,
                         const SightHistory& history);
  void decide(Track& track, double stamp, Candidate& candidate, const std::array<Former, 2>& former);
  static void leaveTrace(Track& track, const JudgedScan& scan, const Candidate& candidate);
  void describe(const Track& track, const JudgedScan& scan, const Candidate& candidate);

  ObjectConfig config_;
  std::vector<Track> tracks_;
  std::vector<Pair> pairs_;
  std::vector<int> track_of_;  ///< by candidate, -1 where it is followed for the first time
  std::vector<Object> objects_;
  std::uint32_t next_id_ = 1;
};

}  // namespace donex
