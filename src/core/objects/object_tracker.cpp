#include "core/objects/object_tracker.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/objects/oriented_box.h"

namespace donex {
namespace {

constexpr double kLargestStep = 4.0;  // [m] between two scans, before a velocity is known
constexpr double kLost = 0.6;         // [s] unseen for longer: forgotten
// An object's former place is asked for after these times [s]: soon for the fast, later again for the slow.
constexpr std::array<double, 3> kLookBack = {0.3, 0.6, 1.0};
constexpr double kSmoothing = 0.3;  // share of the newest displacement in the velocity
constexpr int kScansToBelieve = 2;
constexpr double kMovesOn = 1.0;          // [s] after it was seen to move as one, a thing does so still
constexpr double kSurelyMoving = 5.0;     // [m/s] a hedge that comes into view step by step seems slower
constexpr double kReleaseAfter = 0.3;     // [s] but its parts are released sooner
constexpr double kForgetExtent = 0.9;     // of the former extent remains, a scan
constexpr double kRim = 0.5;              // [m] around a moving thing
constexpr double kSettledFragment = 0.2;  // share

}  // namespace

ObjectTracker::ObjectTracker(const ObjectConfig& config) : config_(config), traces_(kLookBack.back(), kLost) {}

void ObjectTracker::update(const JudgedScan& scan, const SightHistory& history, Candidates& candidates) {
  objects_.clear();
  expect(scan.stamp, &Track::full_extent);
  sensor_ = scan.odom_from_points * scan.sensor.cast<double>();
  traces_.begin(scan.stamp);
  match(scan.stamp, candidates);
  const MotionEvidence evidence(scan, history);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    Candidate& candidate = candidates[i];
    if (isTooLong(candidate)) continue;
    Track& track = trackOf(i, scan.stamp, candidate);
    if (config_.motion) weigh(track, evidence, scan.stamp, candidate);
    decide(track, scan.stamp, candidate);
    if (config_.motion) track.trace = traces_.leave(scan, candidate, track.trace);
    if (track.ever_dynamic) describe(track, scan, candidate);
  }
  complete(candidates);
  const auto is_lost = [&](const Track& track) { return track.last_seen < scan.stamp - kLost; };
  tracks_.erase(std::remove_if(tracks_.begin(), tracks_.end(), is_lost), tracks_.end());
}

const std::vector<Expected>& ObjectTracker::expect(double stamp, Eigen::Vector3d Track::*extent) {
  expected_.clear();
  for (const Track& track : tracks_) {
    if (!track.dynamic) continue;
    const bool goes_on = stamp - track.last_moved_whole < kMovesOn && track.velocity.norm() > kSurelyMoving;
    expected_.push_back({track.centerAt(stamp), track.*extent, goes_on});
  }
  return expected_;
}

ObjectTracker::Track& ObjectTracker::trackOf(std::size_t candidate_index, double stamp, const Candidate& candidate) {
  const int known = track_of_[candidate_index];
  if (known >= 0) {
    follow(tracks_[static_cast<std::size_t>(known)], stamp, candidate);
    return tracks_[static_cast<std::size_t>(known)];
  }
  Track track;
  track.id = next_id_++;
  track.first_seen = track.last_seen = stamp;
  track.center = candidate.center();
  track.extent = track.full_extent = candidate.extent();
  tracks_.push_back(std::move(track));
  return tracks_.back();
}

void ObjectTracker::match(double stamp, const Candidates& candidates) {
  pairs_.clear();
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    const Track& track = tracks_[t];
    const Eigen::Vector3d predicted = track.centerAt(stamp);
    const double step = track.first_seen < track.last_seen ? kFollowed : kLargestStep;
    for (std::size_t c = 0; c < candidates.size(); ++c) {
      const double distance = (candidates[c].center() - predicted).norm();
      if (distance > step || !alike(track.extent, candidates[c].extent())) continue;
      pairs_.push_back({distance, t, c});
    }
  }
  // The nearest pairs first: what stands still finds itself and leaves the rest to what moves.
  std::sort(pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) {
    return std::tie(a.distance, a.track, a.candidate) < std::tie(b.distance, b.track, b.candidate);
  });
  track_of_.assign(candidates.size(), -1);
  for (Track& track : tracks_) track.is_found = false;
  for (const Pair& pair : pairs_) {
    if (tracks_[pair.track].is_found || track_of_[pair.candidate] >= 0) continue;
    tracks_[pair.track].is_found = true;
    track_of_[pair.candidate] = static_cast<int>(pair.track);
  }
}

void ObjectTracker::follow(Track& track, double stamp, const Candidate& candidate) {
  const double elapsed = stamp - track.last_seen;
  if (elapsed > 0.0) {
    const Eigen::Vector3d velocity = (candidate.center() - track.center) / elapsed;
    const bool is_second = track.last_seen <= track.first_seen;
    track.velocity =
        is_second ? velocity : Eigen::Vector3d((1.0 - kSmoothing) * track.velocity + kSmoothing * velocity);
  }
  track.center = candidate.center();
  track.extent = candidate.extent();
  track.full_extent = track.extent.cwiseMax(kForgetExtent * track.full_extent);
  track.last_seen = stamp;
}

void ObjectTracker::weigh(Track& track, const MotionEvidence& evidence, double stamp,
                          const Candidate& candidate) const {
  bool receded = false, advanced = false, moved = false;
  // What was cut out where it was expected cannot prove by its place that it went there.
  Trace trace;
  const bool may_tell = !candidate.cut_out && !isMostlySettled(candidate);
  for (const double ago : kLookBack) {
    if (!may_tell || !traces_.find(track.trace, stamp - ago, trace)) continue;
    const Former former = evidence.lookBack(trace);
    receded |= former.left >= config_.min_echoes && former.left > former.still;
    advanced |= former.left >= kLeastLeft && candidate.new_echoes >= config_.min_echoes;
    moved = moved || evidence.hasMoved(trace, candidate);
  }
  track.receding_scans = receded ? track.receding_scans + 1 : 0;
  track.advancing_scans = advanced ? track.advancing_scans + 1 : 0;
  track.moving_scans = moved ? track.moving_scans + 1 : 0;
}

void ObjectTracker::decide(Track& track, double stamp, Candidate& candidate) const {
  const bool moves_whole = track.receding_scans >= kScansToBelieve || track.moving_scans >= kScansToBelieve;
  const bool has_evidence = moves_whole || track.advancing_scans >= kScansToBelieve || isNew(candidate, config_);
  const bool moves = has_evidence && !isThin(candidate, sensor_);
  if (moves_whole) track.last_moved_whole = stamp;
  if (moves) track.last_motion = stamp;
  const bool just_stopped =
      track.dynamic && !isMostlySettled(candidate) && stamp - track.last_motion <= config_.stop_time;
  track.dynamic = moves || just_stopped;
  track.ever_dynamic = track.ever_dynamic || track.dynamic;
  candidate.dynamic = track.dynamic;
  candidate.moves_whole = stamp - track.last_moved_whole <= kReleaseAfter;
}

void ObjectTracker::complete(Candidates& candidates) const {
  // A pole before a vehicle leaves fragments of it, too small to tell anything themselves.
  for (const Expected& whole : expected_) {
    if (!whole.moves_whole || !whole.isLong()) continue;
    const Eigen::Array3d half = 0.5 * whole.extent.array() + kRim;
    for (Candidate& candidate : candidates) {
      const bool settled = candidate.settled_echoes > kSettledFragment * static_cast<double>(candidate.echoes.size());
      const bool inside = ((candidate.low - whole.center).array() > -half).all() &&
                          ((candidate.high - whole.center).array() < half).all();
      if (inside && !settled && !candidate.dynamic) candidate.dynamic = candidate.moves_whole = true;
    }
  }
}

void ObjectTracker::describe(const Track& track, const JudgedScan& scan, const Candidate& candidate) {
  Object object;
  object.id = track.id;
  object.velocity = track.velocity;
  object.dynamic = track.dynamic;
  object.age = scan.stamp - track.first_seen;
  object.echoes = static_cast<std::uint32_t>(candidate.echoes.size());
  fitBox(candidate.echoes, scan.points, scan.odom_from_points, track.velocity, object);
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
         expected_.capacity() * sizeof(Expected) + track_of_.capacity() * sizeof(int) +
         objects_.capacity() * sizeof(Object);
}

}  // namespace donex
