#include "donex/core/object_tracker.h"

#include <algorithm>
#include <cmath>

#include "donex/core/oriented_box.h"

namespace donex {
namespace {

constexpr double kLargestStep = 4.0;       // [m] between two scans, before a velocity is known
constexpr double kFollowedStep = 1.5;      // [m] off the predicted place
constexpr double kLost = 0.6;              // [s] unseen for longer: forgotten
// An object's former place is asked for after these times [s]: soon for the fast, later again for the slow.
constexpr std::array<double, 2> kLookBack = {0.3, 1.0};
constexpr std::size_t kTracePoints = 48;
constexpr double kSmoothing = 0.3;         // share of the newest displacement in the velocity
constexpr int kScansToBelieve = 2;
constexpr int kLeastLeft = 3;              // points of a trace

bool alike(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return ((a - b).array().abs() <= (0.5 * a.cwiseMax(b)).array() + 0.7).all();
}

}  // namespace

void ObjectTracker::update(const JudgedScan& scan, const SightHistory& history, std::vector<Candidate>& candidates) {
  objects_.clear();
  match(scan.stamp, candidates);
  const Eigen::Isometry3d points_from_odom = scan.odom_from_points.inverse();
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    Candidate& candidate = candidates[i];
    if (isTooLong(candidate)) continue;
    Track& track = trackOf(i, scan.stamp, candidate);
    std::array<Former, 2> former;
    for (std::size_t k = 0; k < former.size(); ++k) {
      former[k] = lookBack(track, scan.stamp - kLookBack[k], points_from_odom, history);
    }
    decide(track, scan.stamp, candidate, former);
    leaveTrace(track, scan, candidate);
    if (track.ever_dynamic) describe(track, scan, candidate);
  }
  const auto is_lost = [&](const Track& track) { return track.last_seen < scan.stamp - kLost; };
  tracks_.erase(std::remove_if(tracks_.begin(), tracks_.end(), is_lost), tracks_.end());
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
  track.extent = candidate.extent();
  tracks_.push_back(std::move(track));
  return tracks_.back();
}

void ObjectTracker::match(double stamp, const std::vector<Candidate>& candidates) {
  pairs_.clear();
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    const Track& track = tracks_[t];
    const Eigen::Vector3d predicted = track.center + track.velocity * (stamp - track.last_seen);
    const double step = track.first_seen < track.last_seen ? kFollowedStep : kLargestStep;
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
  std::vector<bool> taken(tracks_.size(), false);
  for (const Pair& pair : pairs_) {
    if (taken[pair.track] || track_of_[pair.candidate] >= 0) continue;
    taken[pair.track] = true;
    track_of_[pair.candidate] = static_cast<int>(pair.track);
  }
}

void ObjectTracker::follow(Track& track, double stamp, const Candidate& candidate) {
  const double elapsed = stamp - track.last_seen;
  if (elapsed > 0.0) {
    const Eigen::Vector3d velocity = (candidate.center() - track.center) / elapsed;
    const bool is_second = track.last_seen <= track.first_seen;
    track.velocity = is_second ? velocity : Eigen::Vector3d((1.0 - kSmoothing) * track.velocity + kSmoothing * velocity);
  }
  track.center = candidate.center();
  track.extent = candidate.extent();
  track.last_seen = stamp;
}

ObjectTracker::Former ObjectTracker::lookBack(const Track& track, double to,
                                              const Eigen::Isometry3d& points_from_odom,
                                              const SightHistory& history) {
  const Trace* former = nullptr;
  for (const Trace& trace : track.traces) {
    if (trace.stamp <= to) former = &trace;
  }
  Former result;
  if (former == nullptr) return result;
  for (const Eigen::Vector3d& point : former->in_odom) {
    const SightImage::Sight sight = history.askNewest((points_from_odom * point).cast<float>());
    result.left += sight == SightImage::Sight::kFree ? 1 : 0;
    result.still += sight == SightImage::Sight::kSurface ? 1 : 0;
  }
  return result;
}

void ObjectTracker::decide(Track& track, double stamp, Candidate& candidate, const std::array<Former, 2>& former) {
  const bool mostly_settled = 2 * static_cast<std::size_t>(candidate.settled_echoes) > candidate.echoes.size();
  bool receded = false, advanced = false;
  for (const Former& then : former) {
    receded |= !mostly_settled && then.left >= config_.min_echoes && then.left > then.still;
    advanced |= !mostly_settled && then.left >= kLeastLeft && candidate.new_echoes >= config_.min_echoes;
  }
  track.receding_scans = receded ? track.receding_scans + 1 : 0;
  track.advancing_scans = advanced ? track.advancing_scans + 1 : 0;
  const bool moves = isNew(candidate, config_) || track.receding_scans >= kScansToBelieve || track.advancing_scans >= kScansToBelieve;
  if (moves) track.last_motion = stamp;
  const bool just_stopped = track.dynamic && !mostly_settled && stamp - track.last_motion <= config_.stop_time;
  track.dynamic = moves || just_stopped;
  track.ever_dynamic = track.ever_dynamic || track.dynamic;
  candidate.dynamic = track.dynamic;
}

void ObjectTracker::leaveTrace(Track& track, const JudgedScan& scan, const Candidate& candidate) {
  Trace trace;
  while (track.traces.size() > 1 && track.traces[1].stamp <= scan.stamp - kLookBack[1]) {
    trace = std::move(track.traces.front());  // its storage is used again
    track.traces.pop_front();
  }
  trace.stamp = scan.stamp;
  trace.in_odom.clear();
  const std::size_t stride = candidate.echoes.size() / kTracePoints + 1;
  for (std::size_t i = 0; i < candidate.echoes.size(); i += stride) {
    trace.in_odom.push_back(scan.odom_from_points * scan.points[candidate.echoes[i]].cast<double>());
  }
  track.traces.push_back(std::move(trace));
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
  next_id_ = 1;
}

std::size_t ObjectTracker::memoryBytes() const {
  std::size_t bytes = tracks_.capacity() * sizeof(Track) + pairs_.capacity() * sizeof(Pair);
  for (const Track& track : tracks_) {
    for (const Trace& trace : track.traces) bytes += trace.in_odom.capacity() * sizeof(Eigen::Vector3d);
  }
  return bytes;
}

}  // namespace donex
