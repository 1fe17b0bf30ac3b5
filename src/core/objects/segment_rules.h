// What a segment's extent and places say of it (algorithm: "Segments", "Proofs of motion").
#pragma once

#include "core/objects/segment.h"
#include "donex/config.h"

namespace donex {

struct SegmentOptions {
  double longest = 25.0;           ///< beyond: a wall, a hedge, or objects that touch [m]
  double least_new_share = 0.15;   ///< of all echoes that must be new: less is the frayed edge of something that stands
  double unsure_new_share = 0.5;   ///< of all echoes that must be new where they are not surely so
  double least_fresh_share = 0.1;  ///< of the new echoes that must not linger: what moves hits new places all the time
  double low = 0.5;                ///< what is lower fits between beams [m]
  double most_coarse = 0.5;    ///< of the new echoes of something low: with more that are so it may have stood before
  double slim = 0.15;          ///< what is so slim and higher than `low` is a pole [m]
  double narrow = 0.25;        ///< a strip of something larger, seen through a gap, may be narrower than that [m]
  double rail_length = 3.0;    ///< what is longer, and lower than `rail_height`, is a rail or a kerb [m]
  double rail_height = 0.6;    ///< of rails and kerbs at most [m]
  double one_beam = 0.12;      ///< what is lower was hit by one beam alone [m]
  double high = 0.8;           ///< where that begins higher, no beam hit what holds it up [m]
  double overhead = 2.0;       ///< above ground: above people's heads [m]
  double upright_ratio = 0.3;  ///< height by length: about that of a car
  double thin_angle = 0.02;    ///< seen under less, it is no higher than one or two beams of any sensor [rad]
  double thin_reach = 20.0;    ///< farther away beams are too sparse to tell [m]
  double long_extent = 1.75;   ///< the width of a car: seen from any side, a vehicle is longer [m]
  double followed_distance = 1.5;  ///< farther from its predicted place a followed object is not looked for [m]
  double prediction_rim = 0.2;     ///< by which a predicted object's centre may leave the segment it is within [m]
  double other_view_share = 0.5;   ///< of the extent that another view of the same object may not show
  double frayed_ends = 0.7;        ///< and as much at its ends, where few echoes hit: counts for small objects [m]
};

/// Without memory: each answer follows from the segment, and from the prediction where there is one.
class SegmentRules {
 public:
  explicit SegmentRules(const ObjectConfig& config, const SegmentOptions& options = {})
      : config_(config), options_(options) {}

  /// Longer than any vehicle: a wall, a hedge, or objects that touch.
  bool isTooLong(const Segment& segment) const;

  /// More of it is settled than not.
  static bool isMostlySettled(const Segment& segment);

  /// Enough of the segment is new, by number and against what is settled, and it cannot have stood between beams.
  bool isNew(const Segment& segment) const;

  /// Its new places are not all of those that what has stopped leaves.
  bool isFresh(const Segment& segment) const;

  /// Something low that beams saw through which lay far apart there: a guard rail, a kerb.
  bool fitsBetweenBeams(const Segment& segment) const;

  /// All that is new of it lies above people's heads and is no higher than a beam or two: an eave, a branch, a cable.
  /// `sensor` in the odometry frame.
  bool isNewOverhead(const Segment& segment, const Eigen::Vector3d& sensor) const;

  /// Not a patch of ground or a roof, whose shape fits wherever it is shifted along itself.
  bool isUpright(const Segment& segment) const;

  /// Narrower than anything that moves: its shape fits anywhere along that which it is a strip of.
  bool isNarrow(const Segment& segment) const;

  /// Near, and yet hardly higher than a beam: an edge, a wire, a branch. `sensor` in the odometry frame.
  bool isThin(const Segment& segment, const Eigen::Vector3d& sensor) const;

  /// Its rear tells: unlike a rail's end, or a single beam's on the upper part of something that stands, which leave
  /// their places as the sensor comes nearer and other beams hit them.
  bool hasRear(const Segment& segment) const;

  /// Upright and slimmer than anything that moves: where beams beside one another lie farther apart, whole scans miss
  /// it.
  bool isPole(const Segment& segment) const;

  /// Extents [m] that may be those of one object, seen from two places.
  bool areAlike(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;

  /// As long as a car is wide, at least: its own side settles under it as it slides along itself.
  bool isLong(const Eigen::Vector3d& extent) const;

  /// The segment may be the predicted object.
  bool looksLike(const Segment& segment, const Prediction& object) const;
  /// The predicted object is somewhere in the segment, which is more than that.
  bool holds(const Segment& segment, const Prediction& object) const;

  const SegmentOptions& options() const { return options_; }

 private:
  ObjectConfig config_;
  SegmentOptions options_;
};

}  // namespace donex
