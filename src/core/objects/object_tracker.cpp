#include "core/objects/object_tracker.h"

#include <algorithm>
#include <cmath>

#include "core/objects/oriented_box.h"

namespace donex {
ObjectTracker::ObjectTracker(const ObjectConfig& config, const TrackerOptions& options)
    : config_(config), options_(options), rules_(config), traces_(options.look_back.back(), options.lost_after) {}

void ObjectTracker::predict(const JudgedScan& scan, Predictions& predictions) const {
  predictions.clear();
  for (const Followed& followed : tracks_) {
    const bool is_of_this_turn = scan.continues_turn && followed.turn == turn_;
    if (is_of_this_turn && !followed.before) continue;
    const Track& track = is_of_this_turn ? *followed.before : followed.now;
    const bool is_displaced = track.displaced.isSeen();
    if (!track.dynamic && !is_displaced) continue;
    const bool goes_on = track.dynamic && scan.stamp - track.last_moved_whole < options_.moves_on &&
                         track.velocity.norm() > options_.moves_on_speed;
    predictions.push_back(
        {track.centerAt(scan.stamp), track.extent, track.full_extent, goes_on, is_displaced, track.dynamic});
  }
}

void ObjectTracker::update(const JudgedScan& scan, const Segments& segments, const Predictions& predictions,
                           const ScanSight& now, Verdicts& verdicts, const Workers& workers) {
  objects_.clear();
  segment_of_.clear();
  verdicts.assign(segments.size(), Verdict{});
  sensor_ = scan.odom_from_points * scan.sensor.cast<double>();
  if (!scan.continues_turn) ++turn_;
  traces_.begin(scan.stamp);
  match(scan.stamp, segments);
  const MotionTests tests(scan, now, test_options_);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (!rules_.isTooLong(segments[i])) followOn(i, scan.stamp, segments[i]);
  }
  if (config_.motion) placeWorld(scan.stamp, segments);
  // Each has a track of its own, and asks for traces of earlier scans.
  const auto judge = [&](std::size_t i) {
    if (rules_.isTooLong(segments[i])) return;
    if (config_.motion) testMotion(trackOf(i), tests, scan.stamp, segments[i]);
    if (!segments[i].is_mixed) verdicts[i] = decide(trackOf(i), tests, scan.stamp, segments[i]);
  };
  workers.each(segments.size(), std::ref(judge));
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (rules_.isTooLong(segments[i])) continue;
    Track& track = trackOf(i);
    if (config_.motion) track.trace = traces_.leave(scan, segments[i], track.trace);
    if (track.ever_dynamic && !segments[i].is_mixed) addObject(i, verdicts[i].proof, scan.stamp);
  }
  complete(segments, predictions, verdicts);
  const auto is_lost = [&](const Followed& followed) {
    return followed.now.last_seen < scan.stamp - options_.lost_after;
  };
  tracks_.erase(std::remove_if(tracks_.begin(), tracks_.end(), is_lost), tracks_.end());
}

ObjectTracker::Track ObjectTracker::newTrack(std::uint32_t id, double stamp, const Segment& segment) {
  Track track;
  track.id = id;
  track.first_seen = track.last_seen = stamp;
  track.center = segment.center();
  track.extent = track.full_extent = segment.extent();
  track.rest = {segment.low, segment.high, stamp};
  track.is_mixed = segment.is_mixed;
  return track;
}

/// Sees the track of a segment there, or begins one.
void ObjectTracker::followOn(std::size_t segment_index, double stamp, const Segment& segment) {
  int& track = track_of_[segment_index];
  if (track < 0) {
    track = static_cast<int>(tracks_.size());
    tracks_.push_back({newTrack(next_id_++, stamp, segment), {}, turn_});
    return;
  }
  Followed& followed = tracks_[static_cast<std::size_t>(track)];
  if (isNewcomer(followed)) {
    followed.now = newTrack(followed.now.id, stamp, segment);
    return;
  }
  followed.before = beforeTurn(followed);
  followed.turn = turn_;
  follow(followed.now = *followed.before, stamp, segment);
}

void ObjectTracker::match(double stamp, const Segments& segments) {
  track_of_.assign(segments.size(), -1);
  for (Followed& followed : tracks_) followed.is_found = false;
  claimParts(segments);
  pairs_.clear();
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    const Followed& followed = tracks_[t];
    const bool is_complete = followed.turn == turn_ && !followed.is_claimed;
    if (is_complete || isNewcomer(followed)) continue;
    const Track& track = beforeTurn(followed);
    const Eigen::Vector3d predicted = track.centerAt(stamp);
    const double step = stepOf(track);
    for (std::size_t c = 0; c < segments.size(); ++c) {
      const Eigen::Vector3d offset = segments[c].center() - predicted;
      if (std::abs(offset.x()) > step || std::abs(offset.y()) > step) continue;  // most are, and need no root
      const double distance = offset.norm();
      const bool is_alike = distance <= step && rules_.areAlike(track.extent, segments[c].extent());
      if (is_alike) pairs_.push_back({track.is_mixed != segments[c].is_mixed, distance, t, c});
    }
  }
  // The nearest pairs first: what stands still finds itself and leaves the rest to what moves. Something mixed that was
  // not so before, or the other way round, takes what is left then.
  std::sort(pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) {
    return std::tie(a.are_unlike, a.distance, a.track, a.segment) <
           std::tie(b.are_unlike, b.distance, b.track, b.segment);
  });
  for (const Pair& pair : pairs_) {
    if (tracks_[pair.track].is_found || track_of_[pair.segment] >= 0) continue;
    tracks_[pair.track].is_found = true;
    track_of_[pair.segment] = static_cast<int>(pair.track);
  }
  settleClaims();
}

/// What goes on from an earlier part of the turn is known already, but with more of it another track may fit better.
void ObjectTracker::claimParts(const Segments& segments) {
  claim_of_.assign(segments.size(), -1);
  for (Followed& followed : tracks_) followed.is_claimed = false;
  for (std::size_t c = 0; c < segments.size(); ++c) {
    if (segments[c].object == 0) continue;
    const auto known = std::find_if(tracks_.begin(), tracks_.end(), [&](const Followed& followed) {
      return followed.now.id == segments[c].object && !followed.is_claimed;
    });
    if (known == tracks_.end()) continue;
    known->is_claimed = true;
    claim_of_[c] = static_cast<int>(known - tracks_.begin());
  }
}

void ObjectTracker::settleClaims() {
  for (std::size_t c = 0; c < claim_of_.size(); ++c) {
    if (claim_of_[c] < 0) continue;
    Followed& claimed = tracks_[static_cast<std::size_t>(claim_of_[c])];
    if (claimed.is_found) continue;
    if (track_of_[c] < 0) {
      claimed.is_found = true;
      track_of_[c] = claim_of_[c];
    } else if (isNewcomer(claimed)) {
      claimed.now.last_seen = kNever;  // what it was taken for is another track
    } else if (claimed.turn == turn_) {
      claimed.now = *claimed.before;  // as if it had not been seen in this turn
      claimed.turn = turn_ - 1;
    }
  }
}

double ObjectTracker::stepOf(const Track& track) const {
  const bool has_velocity = track.first_seen < track.last_seen;
  return has_velocity ? rules_.options().followed_distance : options_.first_step;
}

void ObjectTracker::follow(Track& track, double stamp, const Segment& segment) const {
  const double elapsed = stamp - track.last_seen;
  if (elapsed > 0.0 && !segment.is_of_two_turns) {
    const Eigen::Vector3d velocity = (segment.center() - track.center) / elapsed;
    const bool is_second = track.last_seen <= track.first_seen;
    const double newest = is_second ? 1.0 : 1.0 - std::exp(-elapsed / options_.velocity_time);
    track.velocity = (1.0 - newest) * track.velocity + newest * velocity;
  }
  track.center = segment.center();
  track.extent = segment.extent();
  track.full_extent = track.extent.cwiseMax(std::exp(-elapsed / options_.extent_time) * track.full_extent);
  track.last_seen = stamp;
  track.is_mixed = segment.is_mixed;
  const Eigen::Array3d low_shift = (segment.low - track.rest.low).array().abs();
  const Eigen::Array3d high_shift = (segment.high - track.rest.high).array().abs();
  if (low_shift.max(high_shift).maxCoeff() > options_.rest_shift) track.rest = {segment.low, segment.high, stamp};
}

/// How the world seems to have shifted, from what is followed.
void ObjectTracker::placeWorld(double stamp, const Segments& segments) {
  Trace trace;
  for (std::size_t k = 0; k < shifts_.size(); ++k) {
    shifts_[k].begin(sensor_);
    for (std::size_t i = 0; i < segments.size(); ++i) {
      const bool is_one = !segments[i].is_of_two_turns && !segments[i].is_mixed && !rules_.isTooLong(segments[i]);
      const bool tells = is_one && segments[i].echoes.size() >= options_.places_world;
      if (tells && traces_.find(trackOf(i).trace, stamp - options_.look_back[k], trace)) {
        shifts_[k].add(trace, segments[i]);
      }
    }
    shifts_[k].solve();
  }
}

void ObjectTracker::testMotion(Track& track, const MotionTests& tests, double stamp, const Segment& segment) const {
  bool receded = false, advanced = false, moved = false, displaced = false;
  Trace trace;
  for (std::size_t k = 0; k < options_.look_back.size(); ++k) {
    // What was cut out where it was predicted cannot prove by its place that it went there.
    if (segment.cut_out || !traces_.find(track.trace, stamp - options_.look_back[k], trace)) continue;
    trace.move(shifts_[k].nowFromThen());
    const bool has_shape = !segment.is_of_two_turns && !rules_.isNarrow(segment);  // of one time, and its own
    displaced = displaced || (has_shape && tests.isDisplaced(trace, segment, shifts_[k].isKnown()));
    if (segment.is_mixed || SegmentRules::isMostlySettled(segment)) continue;
    const FormerPlace former = tests.lookBack(trace);
    receded |= former.left >= config_.min_echoes && former.left > former.still;
    advanced |= former.left >= test_options_.least_left && segment.new_echoes >= config_.min_echoes;
    const bool has_changed = std::max(segment.new_echoes, former.left) >= test_options_.least_left;
    const bool fit_tells = has_shape && (rules_.isUpright(segment) || has_changed);
    moved = moved || (fit_tells && tests.hasMoved(trace, segment));
  }
  track.receding.see(receded, stamp);
  track.advancing.see(advanced, stamp);
  track.shifting.see(moved, stamp);
  track.displaced.see(displaced, stamp);
}

/// All proofs of motion, those of the whole segment first.
Proof ObjectTracker::proofOf(const Track& track, const MotionTests& tests, double stamp, const Segment& segment) const {
  if (segment.is_of_plume) return Proof::kNone;
  // Signs tell what has moved within the last second; its box tells that it has stopped since.
  const bool rests = stamp - track.rest.since >= options_.rests_after;
  if (!rests && !rules_.isThin(segment, sensor_) && !tests.hangs(segment)) {
    if (rules_.hasRear(segment) && isBelieved(track.receding, stamp)) return Proof::kRearReceded;
    if (isBelieved(track.shifting, stamp) || isBelieved(track.displaced, stamp)) return Proof::kShapeElsewhere;
    if (isBelieved(track.advancing, stamp)) return Proof::kEndsMoved;
    if (hasEntered(segment)) return Proof::kEnteredFree;
  }
  // What was proven by its new echoes alone, and has none any more, is what they uncovered: a car behind its open door.
  const bool is_it_still = segment.freshEchoes() > 0 || stamp - track.last_moved_whole <= options_.moves_on;
  const bool just_stopped = track.dynamic && is_it_still && !SegmentRules::isMostlySettled(segment) &&
                            stamp - track.last_motion <= config_.stop_time;
  return just_stopped ? Proof::kMovedBefore : Proof::kNone;
}

bool ObjectTracker::hasEntered(const Segment& segment) const {
  return rules_.isNew(segment) && rules_.isFresh(segment) && !rules_.isPole(segment) &&
         !rules_.isNewOverhead(segment, sensor_);
}

Verdict ObjectTracker::decide(Track& track, const MotionTests& tests, double stamp, const Segment& segment) const {
  const Proof proof = proofOf(track, tests, stamp, segment);
  const bool is_proven_now = proof != Proof::kNone && proof != Proof::kMovedBefore;
  const bool is_moved_whole =
      isBelieved(track.receding, stamp) || isBelieved(track.shifting, stamp) || isBelieved(track.displaced, stamp);
  if (is_moved_whole) track.last_moved_whole = stamp;
  if (is_proven_now) track.last_motion = stamp;
  track.dynamic = proof != Proof::kNone;
  track.ever_dynamic = track.ever_dynamic || track.dynamic;
  return {proof, stamp - track.last_moved_whole <= options_.released_after, track.id};
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
      if (inside && !settled && !segment.is_mixed && !verdicts[i].moves())
        verdicts[i] = {Proof::kPartOfMoving, true, verdicts[i].object};
    }
  }
}

void ObjectTracker::addObject(std::size_t segment_index, Proof proof, double stamp) {
  const Track& track = trackOf(segment_index);
  Object object;
  object.id = track.id;
  object.velocity = track.velocity;
  object.dynamic = track.dynamic;
  object.proof = proof;
  object.age = stamp - track.first_seen;
  objects_.push_back(object);
  segment_of_.push_back(segment_index);
}

void ObjectTracker::describe(const JudgedScan& scan, const Segments& segments) {
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const Segment& segment = segments[segment_of_[i]];
    objects_[i].echoes = static_cast<std::uint32_t>(segment.echoes.size());
    fitBox(segment.echoes, scan.points, scan.odom_from_points, objects_[i].velocity, objects_[i]);
  }
}

void ObjectTracker::reset() {
  tracks_.clear();
  objects_.clear();
  segment_of_.clear();
  traces_.reset();
  next_id_ = 1;
  turn_ = 0;
}

std::size_t ObjectTracker::memoryBytes() const {
  std::size_t bytes = tracks_.capacity() * sizeof(Followed) + pairs_.capacity() * sizeof(Pair) + traces_.memoryBytes() +
                      (track_of_.capacity() + claim_of_.capacity()) * sizeof(int) +
                      objects_.capacity() * sizeof(Object) + segment_of_.capacity() * sizeof(std::size_t);
  for (const ApparentShift& shift : shifts_) bytes += shift.memoryBytes();
  return bytes;
}

}  // namespace donex
