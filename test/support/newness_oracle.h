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
  bool wasSeenFree(const SightView& before_scan, const Eigen::Vector3f& point, double since, bool settled) const {
    int needed = config_.free_evidence ? config_.free_scans : 1;
    if (settled && config_.careful_sight) needed = config_.settled_free_scans;
    return before_scan.ask(point, since, std::numeric_limits<int>::max()).free >= needed;
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
      const bool is_first_scan = now() == 1;
      const bool free =
          !is_first_scan && (!config_.free_evidence || wasSeenFree(before_scan, point, kBeforeEverything, false));
      voxels_[voxel] = born(voxel, free);
    } else if (known->second.last_hit < now() - 1) {
      const bool settled = !isYoung(known->second.birth, known->second.was_free);
      if (wasSeenFree(before_scan, point, stampOf(known->second.last_hit), settled)) known->second = born(voxel, true);
    }
    State& state = voxels_[voxel];
    state.last_hit = now();
    if (!isYoung(state.birth, state.was_free)) return Place::kSettled;
    if (!state.was_free) return Place::kUnobserved;
    return state.at_surface ? Place::kAtSurface : Place::kNew;
  }

 private:
  struct State {
    int birth = kNever, last_hit = kNever;
    bool was_free = false, at_surface = false;
  };

  State born(const Voxel& voxel, bool was_free) const {
    return {now(), now(), was_free, was_free && config_.neighbourhood && touchesSettled(voxel)};
  }

  /// A surface that was hit in one of the last four scans.
  bool touchesSettled(const Voxel& voxel) const {
    for (const auto& [other, state] : voxels_) {
      int apart = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) apart = std::max(apart, std::abs(other[axis] - voxel[axis]));
      if (apart == 1 && !isYoung(state.birth, state.was_free) && state.last_hit > now() - 4) return true;
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
    if (cell.settled.holds(height)) {
      if (!(missed && wasSeenFree(before_scan, point, stampOf(before), true))) return Place::kSettled;
      cell.settled = HeightRange{};
    }
    if (cell.arrived.holds(height)) return Place::kNew;
    if (cell.found.holds(height) && !missed) return foundPlace(cell, height);
    const bool free =
        now() > 1 && (!config_.free_evidence || wasSeenFree(before_scan, point, kBeforeEverything, false));
    const bool at_surface = free && config_.neighbourhood && touchesSettled(position, height);
    const bool comes = free && !at_surface;
    HeightRange& range = comes ? cell.arrived : cell.found;
    if (range.empty()) (comes ? cell.arrived_birth : cell.found_birth) = now();
    range.extend(height);
    if (at_surface) cell.surfaces.push_back(height);
    return comes ? Place::kNew : foundPlace(cell, height);
  }

 private:
  using Position = std::array<int, 2>;
  struct Cell {
    HeightRange settled, arrived, found;
    std::vector<float> surfaces;  ///< heights in `found` that had been seen free and touched a surface
    int arrived_birth = kNever, found_birth = kNever;
    std::vector<int> hits;  ///< scans
  };

  void age(Cell& cell) {
    cell.hits.push_back(now());
    if (!cell.arrived.empty() && !isYoung(cell.arrived_birth, true)) {
      cell.settled.extend(cell.arrived);
      cell.arrived = HeightRange{};
    }
    if (!cell.found.empty() && !isYoung(cell.found_birth, false)) {
      cell.settled.extend(cell.found);
      cell.found = HeightRange{};
      cell.surfaces.clear();
    }
  }

  /// Between the lowest and the highest that was found at a surface everything is that surface.
  static Place foundPlace(const Cell& cell, float height) {
    const auto [lowest, highest] = std::minmax_element(cell.surfaces.begin(), cell.surfaces.end());
    const bool at_surface = lowest != cell.surfaces.end() && height >= *lowest && height <= *highest;
    return at_surface ? Place::kAtSurface : Place::kUnobserved;
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
