#include "core/evidence/newness.h"

#include <algorithm>
#include <limits>

namespace donex {
namespace {

constexpr double kBeforeEverything = -std::numeric_limits<double>::infinity();
constexpr float kRounding = 1e-3F;  // of sums of certainties
constexpr int kAllScans = std::numeric_limits<int>::max();

/// What a place is that was not hit before, or is taken for one that was not. `touches` a settled surface.
Place placeAtBirth(const PlaceBefore& before, bool touches) {
  if (before.surface || touches) return Place::kAtSurface;
  if (!before.was_free) return Place::kUnobserved;
  Place place = Place::kNew;
  if (before.surely_free) place = both(place, Place::kSurelyNew);
  if (before.coarsely_free) place = both(place, Place::kCoarselyNew);
  if (before.overlooked) place = both(place, Place::kLingering);
  return place;
}

}  // namespace

ScanClock::ScanClock(double birth_window, const ScanClockOptions& options)
    : new_window_(birth_window),
      found_window_(std::min(birth_window, options.found_window)),
      recent_time_(options.recent_time) {}

void ScanClock::begin(double stamp) {
  ++scan_;
  stamps_[scan_ % kRememberedStamps] = stamp;
  advance(new_since_, new_window_);
  advance(found_since_, found_window_);
  advance(recent_since_, recent_time_);
}

void ScanClock::advance(std::uint32_t& since, double window) const {
  while (since < scan_ && stampOf(since) < stampOf(scan_) - window) ++since;
}

void ScanClock::reset() {
  scan_ = 0;
  new_since_ = found_since_ = recent_since_ = 1;
}

double ScanClock::stampOf(std::uint32_t scan) const {
  const bool is_remembered = scan > 0 && scan_ - scan < kRememberedStamps;
  if (!is_remembered) return kBeforeEverything;
  return stamps_[scan % kRememberedStamps];
}

PlaceBefore weigh(const EvidenceConfig& config, const SightView& before, const Eigen::Vector3f& point, double since,
                  bool known, bool settled, const WeighingOptions& options) {
  PlaceBefore place;
  if (!config.free_evidence && !known) {  // the paper: never hit is new
    place.was_free = place.surely_free = true;
    return place;
  }
  const int unsettled = config.free_evidence ? config.free_scans : 1;
  const int needed = settled && config.careful_sight ? config.settled_free_scans : unsettled;
  if (!config.free_evidence) {
    place.was_free = place.surely_free = before.ask(point, since, needed).free >= needed;
    return place;
  }
  const SightView::Evidence seen = before.ask(point, since, kAllScans);
  // A surface that was seen before the last free scan did not come just now, and one that lasts did not at all.
  const bool outweighs = seen.free > options.stale_weight * seen.stale_surface && seen.free >= seen.lasting_surface;
  const float enough = static_cast<float>(needed) - kRounding;
  place.was_free = seen.certain_free >= enough && outweighs;
  place.surely_free = place.was_free && seen.free > seen.stale_surface + seen.hidden;
  place.coarsely_free = place.was_free && seen.fine_free < enough;
  place.overlooked = place.was_free && seen.overlooked >= options.overlooked_time;
  place.surface = !place.was_free && seen.lasting_surface > 0;
  return place;
}

Place Newness3d::judge(const Eigen::Vector3f& in_window, const Eigen::Vector3f& point, const ScanClock& clock,
                       const SightView& before) {
  const Index3 voxel = voxelOf(in_window);
  VoxelRecord& record = memory_.at(voxel);
  if (record.last_hit != clock.scan()) {
    const bool settled = record.occupied() && !clock.isYoung(record.birth, record.was_free);
    const bool missed = record.last_hit + 1 < clock.scan();
    // De-shadowing, asked where the answer matters: only a voxel that is hit again after a gap.
    const double since = record.occupied() ? clock.stampOf(record.last_hit) : kBeforeEverything;
    const PlaceBefore place = missed ? weigh(config_, before, point, since, record.occupied(), settled) : PlaceBefore();
    if (!record.occupied() || place.was_free) {
      record.birth = clock.scan();
      record.was_free = place.was_free;
      record.place = placeAtBirth(place, place.was_free && config_.neighbourhood && touchesSettled(voxel, clock));
    }
    record.last_hit = clock.scan();
  }
  if (!clock.isYoung(record.birth, record.was_free)) return Place::kSettled;
  const bool lingers = isNewPlace(record.place) && !clock.isYoung(record.birth, false);
  return lingers ? both(record.place, Place::kLingering) : record.place;
}

bool Newness3d::touchesSettled(const Index3& voxel, const ScanClock& clock) const {
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        const Index3 neighbour = voxel + Index3(x, y, z);
        if (neighbour == voxel || !window().contains(neighbour)) continue;
        const VoxelRecord* record = memory_.find(neighbour);
        const bool is_surface =
            record != nullptr && !clock.isYoung(record->birth, record->was_free) && clock.isRecent(record->last_hit);
        if (is_surface) return true;
      }
    }
  }
  return false;
}

Newness2d::Newness2d(const Config& config)
    : config_(config.evidence), window_(config), cells_layout_(window_), cells_(cells_layout_.slots()) {}

void Newness2d::shift(const Eigen::Isometry3d& odom_from_base) {
  cells_layout_.scroll(window_, odom_from_base, [&](std::uint32_t slot) { cells_[slot] = Cell{}; });
}

void Newness2d::reset() {
  std::fill(cells_.begin(), cells_.end(), Cell{});
  cells_layout_.reset();
}

void Newness2d::settle(Cell& cell, const ScanClock& clock) const {
  const auto settle_range = [&](HeightRange& range, std::uint32_t birth, bool was_free) {
    if (range.empty() || clock.isYoung(birth, was_free)) return;
    cell.settled.extend(range);
    range = HeightRange{};
  };
  settle_range(cell.arrived, cell.arrived_birth, true);
  settle_range(cell.found, cell.found_birth, false);
  if (cell.arrived.empty()) cell.surely = cell.coarsely = cell.overlooked = HeightRange{};
  if (cell.found.empty()) cell.at_surface = HeightRange{};
}

Place Newness2d::judge(const Eigen::Vector3f& in_window, const Eigen::Vector3f& point, const ScanClock& clock,
                       const SightView& before) {
  const Index3 voxel = voxelOf(in_window);
  const float height = cells_layout_.heightOf(in_window);
  Cell& cell = cellAt(voxel.x(), voxel.y());
  if (cell.last_hit != clock.scan()) {
    settle(cell, clock);
    cell.hit_before = cell.last_hit;
    cell.last_hit = clock.scan();
  }
  const bool is_first_scan = clock.scan() == 1;
  const bool missed = cell.hit_before + 1 < clock.scan() && !is_first_scan;
  const double since = cell.hit_before != 0 ? clock.stampOf(cell.hit_before) : kBeforeEverything;
  PlaceBefore left;
  if (cell.settled.holds(height)) {
    // De-shadowing, asked where the answer matters: only in a cell that is hit again after a gap.
    left = missed ? weigh(config_, before, point, since, true, true) : PlaceBefore();
    if (!left.was_free) return Place::kSettled;
    cell.settled = HeightRange{};
  }
  if (cell.arrived.holds(height)) return cell.placeInArrived(height, clock);
  if (cell.found.holds(height) && !missed) return cell.placeInFound(height);
  // What has left was weighed since its last hit: the surface that it was does not count against what comes now.
  const PlaceBefore place =
      left.was_free || is_first_scan ? left : weigh(config_, before, point, kBeforeEverything, false, false);
  const bool touches = place.was_free && config_.neighbourhood && touchesSettled(voxel.x(), voxel.y(), height);
  const bool comes = place.was_free && !touches;
  HeightRange& range = comes ? cell.arrived : cell.found;
  std::uint32_t& birth = comes ? cell.arrived_birth : cell.found_birth;
  if (range.empty()) birth = clock.scan();
  range.extend(height);
  if (comes && place.surely_free) cell.surely.extend(height);
  if (comes && place.coarsely_free) cell.coarsely.extend(height);
  if (comes && place.overlooked) cell.overlooked.extend(height);
  if (touches || place.surface) cell.at_surface.extend(height);
  return comes ? cell.placeInArrived(height, clock) : cell.placeInFound(height);
}

Place Newness2d::Cell::placeInArrived(float height, const ScanClock& clock) const {
  PlaceBefore before;
  before.was_free = true;
  before.surely_free = surely.holds(height);
  before.coarsely_free = coarsely.holds(height);
  before.overlooked = overlooked.holds(height) || !clock.isYoung(arrived_birth, false);
  return placeAtBirth(before, false);
}

bool Newness2d::touchesSettled(int x, int y, float height) const {
  for (int ny = y - 1; ny <= y + 1; ++ny) {
    for (int nx = x - 1; nx <= x + 1; ++nx) {
      if (nx < 0 || ny < 0 || nx >= window_.extent().x() || ny >= window_.extent().y()) continue;
      const HeightRange& settled = cells_[cells_layout_.slotOf(nx, ny)].settled;
      if (height >= settled.lo - 1.0F && height <= settled.hi + 1.0F) return true;
    }
  }
  return false;
}

}  // namespace donex
