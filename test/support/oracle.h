// Algorithm sections 1 and 2 read literally, as slowly as they are written: std::set and a naive traversal.
#pragma once

#include <array>
#include <map>
#include <set>
#include <vector>

#include "donex/core/grid_2d.h"
#include "donex/core/grid_window.h"

namespace donex::oracle {

using Voxel = std::array<int, 3>;  // grid frame, not the window: it does not change while the window scrolls
using Voxels = std::set<Voxel>;

inline Voxel absolute(const Index3& in_window, const GridWindow& window) {
  const Index3 v = in_window + window.minIndex();
  return {v.x(), v.y(), v.z()};
}

inline bool inWindow(const Voxel& v, const GridWindow& window) {
  return window.contains(Index3(v[0], v[1], v[2]) - window.minIndex());
}

/// The labels of a scan: 1 where the echo is new.
using Labels = std::vector<std::uint8_t>;

/// A remembered thing that moves with the world between two scans of a resampled grid.
struct Content3d {
  Eigen::Vector3d in_odom;
  Voxel voxel;
};

class Donex3d {
 public:
  explicit Donex3d(const Config& config) : window_(config) {}

  Labels process(const Scan& scan) {
    shift(scan.odom_from_base);
    GridScan in_grid;
    window_.enter(scan, in_grid);

    Voxels hit;
    std::vector<Voxel> hit_in_order;
    Labels labels(scan.echoes.size(), 0);
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (in_grid.inside[i] == 0) continue;
      const Voxel v = absolute(voxelOf(in_grid.echoes[i]), window_);
      if (hit.insert(v).second) hit_in_order.push_back(v);
      labels[i] = !is_first_ && memory_.count(v) == 0;
    }
    for (const Eigen::Vector3f& echo : in_grid.echoes) {
      if (!echo.allFinite()) continue;
      for (const Index3& seen_through : LineOfSight(in_grid.origin, echo)) {
        const Voxel v = absolute(seen_through, window_);
        if (hit.count(v) == 0) memory_.erase(v);
      }
    }
    keepContents(hit, hit_in_order);
    memory_.insert(hit.begin(), hit.end());
    is_first_ = false;
    return labels;
  }

  const Voxels& memory() const { return memory_; }
  const GridWindow& window() const { return window_; }

 private:
  void shift(const Eigen::Isometry3d& odom_from_base) {
    window_.moveTo(odom_from_base);
    Voxels moved;
    if (window_.compensation() == Compensation::kScroll) {
      for (const Voxel& v : memory_) {
        if (inWindow(v, window_)) moved.insert(v);
      }
    } else {
      std::vector<Content3d> kept;
      for (Content3d content : contents_) {
        const Eigen::Vector3d in_grid = window_.odomFromGrid().inverse() * content.in_odom / window_.voxelSize();
        for (int axis = 0; axis < 3; ++axis) content.voxel[axis] = static_cast<int>(std::floor(in_grid[axis]));
        if (inWindow(content.voxel, window_) && moved.insert(content.voxel).second) kept.push_back(content);
      }
      contents_ = kept;
    }
    memory_ = moved;
  }

  void keepContents(const Voxels& hit, const std::vector<Voxel>& hit_in_order) {
    std::vector<Content3d> kept;
    for (const Content3d& content : contents_) {
      if (memory_.count(content.voxel) != 0 && hit.count(content.voxel) == 0) kept.push_back(content);
    }
    for (const Voxel& v : hit_in_order) {
      const Eigen::Vector3d center = (Eigen::Array3d(v[0], v[1], v[2]) + 0.5) * window_.voxelSize();
      kept.push_back({window_.odomFromGrid() * center, v});
    }
    contents_ = kept;
  }

  GridWindow window_;
  Voxels memory_;
  std::vector<Content3d> contents_;
  bool is_first_ = true;
};

/// Scrolling 2D grid; heights in voxel edge lengths above index 0 of the grid's frame.
class Donex2d {
 public:
  explicit Donex2d(const Config& config) : window_(config) {}

  using Cell = std::array<int, 2>;

  Labels process(const Scan& scan) {
    window_.moveTo(scan.odom_from_base);
    GridScan in_grid;
    window_.enter(scan, in_grid);
    for (auto cell = ranges_.begin(); cell != ranges_.end();) {
      const Voxel v{cell->first[0], cell->first[1], window_.minIndex().z()};
      cell = inWindow(v, window_) ? std::next(cell) : ranges_.erase(cell);
    }
    // Heights are measured from the window's floor in the first scan, as a float sum of two exact terms.
    if (is_first_) floor_ = window_.minIndex().z();
    const auto lift = static_cast<float>(window_.minIndex().z() - floor_);

    Labels labels(scan.echoes.size(), 0);
    std::map<Cell, HeightRange> own;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (in_grid.inside[i] == 0) continue;
      const Voxel v = absolute(voxelOf(in_grid.echoes[i]), window_);
      const Cell cell{v[0], v[1]};
      const float z = in_grid.echoes[i].z() + lift;
      const auto remembered = ranges_.find(cell);
      const bool is_new = remembered == ranges_.end() || z < remembered->second.lo || z > remembered->second.hi;
      labels[i] = !is_first_ && is_new;
      own[cell].extend(z);
    }
    for (const auto& [cell, range] : own) ranges_[cell] = range;
    is_first_ = false;
    return labels;
  }

  const std::map<Cell, HeightRange>& memory() const { return ranges_; }
  const GridWindow& window() const { return window_; }

 private:
  GridWindow window_;
  std::map<Cell, HeightRange> ranges_;
  int floor_ = 0;
  bool is_first_ = true;
};

}  // namespace donex::oracle
