// Segments followed over time: does this object move? (algorithm: "Tracks", "Proofs of motion")
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "core/grid/workers.h"
#include "core/objects/apparent_shift.h"
#include "core/objects/motion_tests.h"
#include "donex/object.h"

namespace donex {

struct TrackerOptions {
  double first_step = 4.0;  ///< before a velocity is known, an object is looked for within this distance [m]
  double lost_after = 0.6;  ///< unseen for longer: forgotten [s]
  /// An object's former place is asked for after these times: soon for the fast, later again for the slow [s].
  std::array<double, 3> look_back = {0.3, 0.6, 1.0};
  double velocity_time = 0.28;    ///< over which displacements make the velocity [s]
  double believed_after = 0.08;   ///< a sign of motion must last: what one scan says may be a flicker [s]
  double moves_on = 1.0;          ///< after it was seen to move as one, an object does so still [s]
  double moves_on_speed = 5.0;    ///< a hedge that comes into view step by step seems slower [m/s]
  double released_after = 0.3;    ///< but its parts are released sooner [s]
  double rest_shift = 0.15;       ///< of any side of an object's box: less is noise [m]
  double rests_after = 0.45;      ///< without more than that the object has stopped [s]
  double extent_time = 0.95;      ///< over which the extent seen before is forgotten [s]
  std::size_t places_world = 50;  ///< echoes of an object that tells how the world seems to have shifted, at least
  double whole_rim = 0.5;         ///< around an object that moves as one: fragments in it are its own [m]
  double settled_fragment = 0.2;  ///< share of settled echoes from which a fragment is not
};

/// Follows segments from scan to scan. An object moves
///  - where enough of its echoes are new: its front comes into space that was free.
/// With ObjectConfig::motion also
///  - where its former place is now seen free: its rear has receded. This finds a vehicle ahead at the
///    ego vehicle's own speed, whose front nobody sees and whose rear only ever enters its own shadow;
///  - where a little of both is true: the ends of a long vehicle that passes by;
///  - where its former shape fits it at another place, and is gone from the old one, or fits only there.
class ObjectTracker {
 public:
  explicit ObjectTracker(const ObjectConfig& config, const TrackerOptions& options = {});

  /// Where the moving objects should be when the scan was taken, from what was known before its turn.
  void predict(const JudgedScan& scan, Predictions& predictions) const;

  /// Follows the segments of a scan and decides about each; describe() follows. `predictions` are those for the scan;
  /// `now`: what the scan sees, asked in its points.
  void update(const JudgedScan& scan, const Segments& segments, const Predictions& predictions, const ScanSight& now,
              Verdicts& verdicts, const Workers& workers = Workers::alone());

  /// Describes the objects by the segments of the last update, which have their low parts by now.
  void describe(const JudgedScan& scan, const Segments& segments);

  /// Objects of the last scan that move, or moved since they are followed.
  const std::vector<Object>& objects() const { return objects_; }

  void reset();
  std::size_t memoryBytes() const;

 private:
  static constexpr double kNever = -std::numeric_limits<double>::infinity();

  /// Something that is seen in one scan after another.
  class Sign {
   public:
    void see(bool is_seen, double stamp) { since_ = is_seen ? std::min(since_, stamp) : kNotSeen; }
    bool isSeen() const { return since_ < kNotSeen; }
    double seenFor(double stamp) const { return stamp - since_; }  ///< [s], negative where it is not seen

   private:
    static constexpr double kNotSeen = std::numeric_limits<double>::infinity();
    double since_ = kNotSeen;
  };

  /// A box that has stayed as it is, nearly.
  struct Rest {
    Eigen::Vector3d low, high;
    double since = 0.0;
  };
  struct Track {
    std::uint32_t id = 0;
    Eigen::Vector3d center, extent, velocity = Eigen::Vector3d::Zero();
    Eigen::Vector3d full_extent;  ///< as seen when less of it was hidden
    double first_seen = 0.0, last_seen = 0.0;
    double last_motion = kNever, last_moved_whole = kNever;
    Rest rest;
    Sign receding, advancing, shifting, displaced;
    bool dynamic = false, ever_dynamic = false;
    bool is_mixed = false;   ///< where it was seen last
    TraceHistory::Id trace;  ///< its last one

    Eigen::Vector3d centerAt(double stamp) const { return center + velocity * (stamp - last_seen); }
  };
  /// A track, and what it was before the turn in which it was seen last: each part of a turn that shows more of the
  /// object is judged from there.
  struct Followed {
    Track now;
    std::optional<Track> before;  ///< none where that was its first turn
    std::uint32_t turn;           ///< in which it was seen last
    bool is_found = false;        ///< in the present cloud
    bool is_claimed = false;      ///< by a segment of the present cloud that goes on from an earlier part
  };
  struct Pair {
    bool are_unlike;  ///< only one of them is mixed
    double distance;
    std::size_t track, segment;
  };

  static Track newTrack(std::uint32_t id, double stamp, const Segment& segment);
  void match(double stamp, const Segments& segments);
  void claimParts(const Segments& segments);
  void settleClaims();
  double stepOf(const Track& track) const;
  /// Seen for the first time in this turn.
  bool isNewcomer(const Followed& followed) const { return followed.turn == turn_ && !followed.before; }
  const Track& beforeTurn(const Followed& followed) const {
    return followed.turn == turn_ ? *followed.before : followed.now;
  }
  void followOn(std::size_t segment_index, double stamp, const Segment& segment);
  Track& trackOf(std::size_t segment_index) { return tracks_[static_cast<std::size_t>(track_of_[segment_index])].now; }
  void follow(Track& track, double stamp, const Segment& segment) const;
  bool isBelieved(const Sign& sign, double stamp) const { return sign.seenFor(stamp) >= options_.believed_after; }
  void placeWorld(double stamp, const Segments& segments);
  void testMotion(Track& track, const MotionTests& tests, double stamp, const Segment& segment) const;
  Proof proofOf(const Track& track, const MotionTests& tests, double stamp, const Segment& segment) const;
  bool hasEntered(const Segment& segment) const;
  Verdict decide(Track& track, const MotionTests& tests, double stamp, const Segment& segment) const;
  void complete(const Segments& segments, const Predictions& predictions, Verdicts& verdicts) const;
  void addObject(std::size_t segment_index, Proof proof, double stamp);

  ObjectConfig config_;
  TrackerOptions options_;
  SegmentRules rules_;
  MotionTestOptions test_options_;
  Eigen::Vector3d sensor_ = Eigen::Vector3d::Zero();  ///< of the present scan, odometry frame [m]
  TraceHistory traces_;
  /// Of the world, since each of the times to look back.
  std::array<ApparentShift, std::tuple_size_v<decltype(TrackerOptions::look_back)>> shifts_;
  std::vector<Followed> tracks_;
  std::vector<Pair> pairs_;
  std::vector<int> claim_of_;  ///< by segment: the track that it goes on with, or -1
  std::vector<int> track_of_;  ///< by segment, -1 where it has none yet
  std::vector<Object> objects_;
  std::vector<std::size_t> segment_of_;  ///< by object
  std::uint32_t next_id_ = 1;
  std::uint32_t turn_ = 0;
};

}  // namespace donex
