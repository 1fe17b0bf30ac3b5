// The algorithm's evidence of places, as the comments of newness.h word them: std::map of voxels and of cells.
#pragma once

#include <algorithm>
#include <limits>
#include <map>
#include <vector>

#include "core/evidence/judged_scan.h"
#include "core/grid/cell_layout.h"
#include "core/sight/sight_history.h"
#include "support/oracle.h"

namespace donex::oracle {

constexpr double kBeforeEverything = -std::numeric_limits<double>::infinity();
constexpr int kNever = 0;

/// What both grids share. Scans count from 1.
class Newness {
 public:
  explicit Newness(const Config& config) : window(config), config_(config.evidence) {
    new_window_ = config.evidence.birth_age ? config.evidence.birth_window : 0.0;
    found_window_ = std::min(new_window_, 0.5);
  }

  GridWindow window;

 protected:
  void beginScan(double stamp) { stamps_.push_back(stamp); }
  int now() const { return static_cast<int>(stamps_.size()); }
  double stampOf(int scan) const {
    return scan == kNever ? kBeforeEverything : stamps_[static_cast<std::size_t>(scan - 1)];
  }
  bool isYoung(int birth, bool was_free) const {
    return stampOf(birth) >= stamps_.back() - (was_free ? new_window_ : found_window_);
  }
  bool isRecent(int scan) const { return stampOf(scan) >= stamps_.back() - 0.35; }
  /// What earlier scans say of a place. With free evidence scans are weighed: free ones must be more than twice the
  /// surfaces seen before the newest of them, and no fewer than the surfaces seen long ago. How many are needed is
  /// counted by how surely each looked there.
  struct Look {
    bool free = false, surely = false, coarsely = false, overlooked = false, surface = false;
  };
  Look look(const SightView& before_scan, const Eigen::Vector3f& point, double since, bool settled) const {
    int needed = config_.free_evidence ? config_.free_scans : 1;
    if (settled && config_.careful_sight) needed = config_.settled_free_scans;
    const auto seen = before_scan.ask(point, since, std::numeric_limits<int>::max());
    Look look;
    look.free = look.surely = seen.free >= needed;
    if (!config_.free_evidence) return look;
    constexpr float kRounding = 1e-3F;
    look.free = seen.certain_free + kRounding >= static_cast<float>(needed);
    if (seen.free <= 2 * seen.stale_surface || seen.free < seen.lasting_surface) look.free = false;
    look.surely = look.free && 2 * seen.free > seen.free + seen.stale_surface + seen.hidden;
    look.coarsely = look.free && seen.fine_free + kRounding < static_cast<float>(needed);
    look.overlooked = look.free && seen.overlooked >= 0.5;
    look.surface = !look.free && seen.lasting_surface > 0;
    return look;
  }
  /// Of a place that was never hit: without free evidence it is new.
  Look lookAtUnknown(const SightView& before_scan, const Eigen::Vector3f& point) const {
    if (now() == 1) return {};
    if (!config_.free_evidence) return {true, true};
    return look(before_scan, point, kBeforeEverything, false);
  }

  static Place placeOf(bool surely, bool coarsely, bool lingers) {
    return static_cast<Place>(static_cast<unsigned>(Place::kNew) + (surely ? 1U : 0U) + (coarsely ? 2U : 0U) +
                              (lingers ? 4U : 0U));
  }

  EvidenceConfig config_;

 private:
  double new_window_, found_window_;
  std::vector<double> stamps_;
};

class Newness3d : public Newness {
 public:
  using Newness::Newness;

  void begin(const Scan& scan) {
    beginScan(scan.stamp);
    window.moveTo(scan.odom_from_base);
    for (auto voxel = voxels_.begin(); voxel != voxels_.end();) {
      voxel = inWindow(voxel->first, window) ? std::next(voxel) : voxels_.erase(voxel);
    }
  }

  Place judge(const Eigen::Vector3f& in_window, const Eigen::Vector3f& point, const SightView& before_scan) {
    const Voxel voxel = absolute(voxelOf(in_window), window);
    const auto known = voxels_.find(voxel);
    if (known == voxels_.end()) {
      voxels_[voxel] = born(voxel, lookAtUnknown(before_scan, point));
    } else if (known->second.last_hit < now() - 1) {
      const bool settled = !isYoung(known->second.birth, known->second.was_free);
      const Look seen = look(before_scan, point, stampOf(known->second.last_hit), settled);
      if (seen.free) known->second = born(voxel, seen);
    }
    State& state = voxels_[voxel];
    state.last_hit = now();
    if (!isYoung(state.birth, state.was_free)) return Place::kSettled;
    if (state.at_surface) return Place::kAtSurface;
    if (!state.was_free) return Place::kUnobserved;
    return placeOf(state.surely, state.coarsely, state.overlooked || !isYoung(state.birth, false));
  }

 private:
  struct State {
    int birth = kNever, last_hit = kNever;
    bool was_free = false, surely = false, coarsely = false, overlooked = false, at_surface = false;
  };

  State born(const Voxel& voxel, const Look& seen) const {
    const bool touches = seen.free && config_.neighbourhood && touchesSettled(voxel);
    return {now(), now(), seen.free, seen.surely, seen.coarsely, seen.overlooked, touches || seen.surface};
  }

  /// A surface that was hit lately.
  bool touchesSettled(const Voxel& voxel) const {
    for (const auto& [other, state] : voxels_) {
      int apart = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) apart = std::max(apart, std::abs(other[axis] - voxel[axis]));
      if (apart == 1 && !isYoung(state.birth, state.was_free) && isRecent(state.last_hit)) return true;
    }
    return false;
  }

  std::map<Voxel, State> voxels_;
};

class Newness2d : public Newness {
 public:
  using Newness::Newness;

  void begin(const Scan& scan) {
    beginScan(scan.stamp);
    window.moveTo(scan.odom_from_base);
    if (now() == 1) floor_ = window.minIndex().z();
    for (auto cell = cells_.begin(); cell != cells_.end();) {
      const Voxel v{cell->first[0], cell->first[1], window.minIndex().z()};
      cell = inWindow(v, window) ? std::next(cell) : cells_.erase(cell);
    }
  }

  Place judge(const Eigen::Vector3f& in_window, const Eigen::Vector3f& point, const SightView& before_scan) {
    const Voxel voxel = absolute(voxelOf(in_window), window);
    const Position position{voxel[0], voxel[1]};
    const float height = in_window.z() + static_cast<float>(window.minIndex().z() - floor_);
    Cell& cell = cells_[position];
    if (cell.hits.empty() || cell.hits.back() != now()) age(cell);
    const int before = cell.hits.size() > 1 ? cell.hits[cell.hits.size() - 2] : kNever;
    const bool missed = before < now() - 1;
    Look left;  // since the last hit of what was settled and is gone
    if (cell.settled.holds(height)) {
      if (missed) left = look(before_scan, point, stampOf(before), true);
      if (!left.free) return Place::kSettled;
      cell.settled = HeightRange{};
    }
    if (cell.arrived.holds(height)) return arrivedPlace(cell, height);
    if (cell.found.holds(height) && !missed) return foundPlace(cell, height);
    const Look seen = left.free ? left : lookAtUnknown(before_scan, point);
    const bool touches = seen.free && config_.neighbourhood && touchesSettled(position, height);
    const bool comes = seen.free && !touches;
    HeightRange& range = comes ? cell.arrived : cell.found;
    if (range.empty()) (comes ? cell.arrived_birth : cell.found_birth) = now();
    range.extend(height);
    if (comes && seen.surely) cell.sure.push_back(height);
    if (comes && seen.coarsely) cell.coarse.push_back(height);
    if (comes && seen.overlooked) cell.overlooked.push_back(height);
    if (touches || seen.surface) cell.surfaces.push_back(height);
    return comes ? arrivedPlace(cell, height) : foundPlace(cell, height);
  }

 private:
  using Position = std::array<int, 2>;
  struct Cell {
    HeightRange settled, arrived, found;
    std::vector<float> surfaces;    ///< heights in `found` that belonged to a surface
    std::vector<float> sure;        ///< heights in `arrived` that had surely been free
    std::vector<float> coarse;      ///< ... that only beams far apart had seen free
    std::vector<float> overlooked;  ///< ... that had been out of view for half a second
    int arrived_birth = kNever, found_birth = kNever;
    std::vector<int> hits;  ///< scans
  };

  void age(Cell& cell) {
    cell.hits.push_back(now());
    if (!cell.arrived.empty() && !isYoung(cell.arrived_birth, true)) {
      cell.settled.extend(cell.arrived);
      cell.arrived = HeightRange{};
      cell.sure.clear();
      cell.coarse.clear();
      cell.overlooked.clear();
    }
    if (!cell.found.empty() && !isYoung(cell.found_birth, false)) {
      cell.settled.extend(cell.found);
      cell.found = HeightRange{};
      cell.surfaces.clear();
    }
  }

  /// Between the lowest and the highest that was found at a surface everything is that surface; so for what was sure or
  /// coarse.
  static Place foundPlace(const Cell& cell, float height) {
    return isAmong(cell.surfaces, height) ? Place::kAtSurface : Place::kUnobserved;
  }
  Place arrivedPlace(const Cell& cell, float height) const {
    const bool lingers = isAmong(cell.overlooked, height) || !isYoung(cell.arrived_birth, false);
    return placeOf(isAmong(cell.sure, height), isAmong(cell.coarse, height), lingers);
  }
  static bool isAmong(const std::vector<float>& heights, float height) {
    const auto [lowest, highest] = std::minmax_element(heights.begin(), heights.end());
    return lowest != heights.end() && height >= *lowest && height <= *highest;
  }

  /// A settled range within a voxel of this height, in this cell or one around it.
  bool touchesSettled(const Position& position, float height) const {
    for (const auto& [other, cell] : cells_) {
      const bool is_near = std::abs(other[0] - position[0]) <= 1 && std::abs(other[1] - position[1]) <= 1;
      if (is_near && height >= cell.settled.lo - 1.0F && height <= cell.settled.hi + 1.0F) return true;
    }
    return false;
  }

  std::map<Position, Cell> cells_;
  int floor_ = 0;
};

}  // namespace donex::oracle
