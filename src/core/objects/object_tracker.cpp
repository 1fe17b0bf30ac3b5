#include "core/objects/object_tracker.h"

#include <algorithm>
#include <cmath>

#include "core/objects/oriented_box.h"

namespace donex {
ObjectTracker::ObjectTracker(const ObjectConfig& config, const TrackerOptions& options)
    : config_(config), options_(options), rules_(config), traces_(options.look_back.back(), options.lost_after) {}

void ObjectTracker::predict(double stamp, Predictions& predictions) const {
  predictions.clear();
  for (const Track& track : tracks_) {
    if (!track.dynamic) continue;
    const bool goes_on =
        stamp - track.last_moved_whole < options_.moves_on && track.velocity.norm() > options_.moves_on_speed;
    predictions.push_back({track.centerAt(stamp), track.extent, track.full_extent, goes_on});
  }
}

void ObjectTracker::update(const JudgedScan& scan, const Segments& segments, const Predictions& predictions,
                           const ScanSight& now, Verdicts& verdicts) {
  objects_.clear();
  verdicts.assign(segments.size(), Verdict{});
  sensor_ = scan.odom_from_points * scan.sensor.cast<double>();
  traces_.begin(scan.stamp);
  match(scan.stamp, segments);
  const MotionTests tests(scan, now, test_options_);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Segment& segment = segments[i];
    if (rules_.isTooLong(segment)) continue;
    Track& track = trackOf(i, scan.stamp, segment);
    if (config_.motion) testMotion(track, tests, scan.stamp, segment);
    verdicts[i] = decide(track, tests, scan.stamp, segment);
    if (config_.motion) track.trace = traces_.leave(scan, segment, track.trace);
    if (track.ever_dynamic) describe(track, verdicts[i].proof, scan, segment);
  }
  complete(segments, predictions, verdicts);
  const auto is_lost = [&](const Track& track) { return track.last_seen < scan.stamp - options_.lost_after; };
  tracks_.erase(std::remove_if(tracks_.begin(), tracks_.end(), is_lost), tracks_.end());
}

ObjectTracker::Track& ObjectTracker::trackOf(std::size_t segment_index, double stamp, const Segment& segment) {
  const int known = track_of_[segment_index];
  if (known >= 0) {
    follow(tracks_[static_cast<std::size_t>(known)], stamp, segment);
    return tracks_[static_cast<std::size_t>(known)];
  }
  Track track;
  track.id = next_id_++;
  track.first_seen = track.last_seen = stamp;
  track.center = segment.center();
  track.extent = track.full_extent = segment.extent();
  tracks_.push_back(std::move(track));
  return tracks_.back();
}

void ObjectTracker::match(double stamp, const Segments& segments) {
  pairs_.clear();
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    const Track& track = tracks_[t];
    const Eigen::Vector3d predicted = track.centerAt(stamp);
    const bool has_velocity = track.first_seen < track.last_seen;
    const double step = has_velocity ? rules_.options().followed_distance : options_.first_step;
    for (std::size_t c = 0; c < segments.size(); ++c) {
      const double distance = (segments[c].center() - predicted).norm();
      if (distance > step || !rules_.areAlike(track.extent, segments[c].extent())) continue;
      pairs_.push_back({distance, t, c});
    }
  }
  // The nearest pairs first: what stands still finds itself and leaves the rest to what moves.
  std::sort(pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) {
    return std::tie(a.distance, a.track, a.segment) < std::tie(b.distance, b.track, b.segment);
  });
  track_of_.assign(segments.size(), -1);
  for (Track& track : tracks_) track.is_found = false;
  for (const Pair& pair : pairs_) {
    if (tracks_[pair.track].is_found || track_of_[pair.segment] >= 0) continue;
    tracks_[pair.track].is_found = true;
    track_of_[pair.segment] = static_cast<int>(pair.track);
  }
}

void ObjectTracker::follow(Track& track, double stamp, const Segment& segment) const {
  const double elapsed = stamp - track.last_seen;
  if (elapsed > 0.0) {
    const Eigen::Vector3d velocity = (segment.center() - track.center) / elapsed;
    const bool is_second = track.last_seen <= track.first_seen;
    const double newest = is_second ? 1.0 : 1.0 - std::exp(-elapsed / options_.velocity_time);
    track.velocity = (1.0 - newest) * track.velocity + newest * velocity;
  }
  track.center = segment.center();
  track.extent = segment.extent();
  track.full_extent = track.extent.cwiseMax(std::exp(-elapsed / options_.extent_time) * track.full_extent);
  track.last_seen = stamp;
}

void ObjectTracker::testMotion(Track& track, const MotionTests& tests, double stamp, const Segment& segment) const {
  bool receded = false, advanced = false, moved = false;
  // What was cut out where it was predicted cannot prove by its place that it went there.
  Trace trace;
  const bool may_tell = !segment.cut_out && !SegmentRules::isMostlySettled(segment);
  for (const double ago : options_.look_back) {
    if (!may_tell || !traces_.find(track.trace, stamp - ago, trace)) continue;
    const FormerPlace former = tests.lookBack(trace);
    receded |= former.left >= config_.min_echoes && former.left > former.still;
    advanced |= former.left >= test_options_.least_left && segment.new_echoes >= config_.min_echoes;
    const bool has_changed = std::max(segment.new_echoes, former.left) >= test_options_.least_left;
    const bool fit_tells = rules_.isUpright(segment) || has_changed;
    moved = moved || (fit_tells && tests.hasMoved(trace, segment));
  }
  track.receding.see(receded, stamp);
  track.advancing.see(advanced, stamp);
  track.shifting.see(moved, stamp);
}

/// All proofs of motion, those of the whole segment first.
Proof ObjectTracker::proofOf(const Track& track, const MotionTests& tests, double stamp, const Segment& segment) const {
  if (!rules_.isThin(segment, sensor_) && !tests.hangs(segment)) {
    if (isBelieved(track.receding, stamp)) return Proof::kRearReceded;
    if (isBelieved(track.shifting, stamp)) return Proof::kShapeElsewhere;
    if (isBelieved(track.advancing, stamp)) return Proof::kEndsMoved;
    if (rules_.isNew(segment) && !rules_.isNewOverhead(segment, sensor_)) return Proof::kEnteredFree;
  }
  const bool just_stopped =
      track.dynamic && !SegmentRules::isMostlySettled(segment) && stamp - track.last_motion <= config_.stop_time;
  return just_stopped ? Proof::kMovedBefore : Proof::kNone;
}

Verdict ObjectTracker::decide(Track& track, const MotionTests& tests, double stamp, const Segment& segment) const {
  const Proof proof = proofOf(track, tests, stamp, segment);
  const bool is_proven_now = proof != Proof::kNone && proof != Proof::kMovedBefore;
  if (isBelieved(track.receding, stamp) || isBelieved(track.shifting, stamp)) track.last_moved_whole = stamp;
  if (is_proven_now) track.last_motion = stamp;
  track.dynamic = proof != Proof::kNone;
  track.ever_dynamic = track.ever_dynamic || track.dynamic;
  return {proof, stamp - track.last_moved_whole <= options_.released_after};
}

void ObjectTracker::complete(const Segments& segments, const Predictions& predictions, Verdicts& verdicts) const {
  // A pole before a vehicle leaves fragments of it, too small to tell anything themselves.
  for (const Prediction& whole : predictions) {
    if (!whole.moves_whole || !rules_.isLong(whole.full_extent)) continue;
    const Eigen::Array3d half = 0.5 * whole.full_extent.array() + options_.whole_rim;
    for (std::size_t i = 0; i < segments.size(); ++i) {
      const Segment& segment = segments[i];
      const bool settled =
          segment.settled_echoes > options_.settled_fragment * static_cast<double>(segment.echoes.size());
      const bool inside =
          ((segment.low - whole.center).array() > -half).all() && ((segment.high - whole.center).array() < half).all();
      if (inside && !settled && !verdicts[i].moves()) verdicts[i] = {Proof::kPartOfMoving, true};
    }
  }
}

void ObjectTracker::describe(const Track& track, Proof proof, const JudgedScan& scan, const Segment& segment) {
  Object object;
  object.id = track.id;
  object.velocity = track.velocity;
  object.dynamic = track.dynamic;
  object.proof = proof;
  object.age = scan.stamp - track.first_seen;
  object.echoes = static_cast<std::uint32_t>(segment.echoes.size());
  fitBox(segment.echoes, scan.points, scan.odom_from_points, track.velocity, object);
  objects_.push_back(object);
}

void ObjectTracker::reset() {
  tracks_.clear();
  objects_.clear();
  traces_.reset();
  next_id_ = 1;
}

std::size_t ObjectTracker::memoryBytes() const {
  return tracks_.capacity() * sizeof(Track) + pairs_.capacity() * sizeof(Pair) + traces_.memoryBytes() +
         track_of_.capacity() * sizeof(int) + objects_.capacity() * sizeof(Object);
}

}  // namespace donex
