// The paper's rule, read literally and as slowly as it is written: std::set and a naive traversal
// (algorithm: "The paper's rule in 3D", "The paper's rule in 2D").
#pragma once

#include <array>
#include <map>
#include <set>
#include <vector>

#include "core/grid/grid_2d.h"
#include "core/grid/grid_window.h"

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

/// The clouds of a turn, together one scan; each is seen from where its sensor was.
using Clouds = std::vector<Scan>;

/// The clouds in the window, in voxel edge lengths.
inline std::vector<GridScan> entered(const Clouds& turn, const GridWindow& window) {
  std::vector<GridScan> clouds(turn.size());
  for (std::size_t i = 0; i < turn.size(); ++i) window.enter(turn[i], clouds[i]);
  return clouds;
}

/// A remembered content that moves with the world between two scans of a resampled grid.
struct Content3d {
  Eigen::Vector3d in_odom;
  Voxel voxel;
};

class Donex3d {
 public:
  explicit Donex3d(const Config& config) : window_(config) {}

  Labels process(const Scan& scan) { return process(Clouds{scan}); }

  /// Labels of all its clouds, one after the other.
  Labels process(const Clouds& turn) {
    shift(turn.front().odom_from_base);
    Voxels hit;
    std::vector<Voxel> hit_in_order;
    Labels labels;
    const std::vector<GridScan> clouds = entered(turn, window_);
    for (const GridScan& cloud : clouds) {
      for (std::size_t i = 0; i < cloud.echoes.size(); ++i) {
        labels.push_back(0);
        if (cloud.inside[i] == 0) continue;
        const Voxel v = absolute(voxelOf(cloud.echoes[i]), window_);
        if (hit.insert(v).second) hit_in_order.push_back(v);
        labels.back() = !is_first_ && memory_.count(v) == 0;
      }
    }
    for (const GridScan& cloud : clouds) forgetSeenThrough(cloud, hit);
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

  void forgetSeenThrough(const GridScan& cloud, const Voxels& hit) {
    for (const Eigen::Vector3f& echo : cloud.echoes) {
      if (!echo.allFinite()) continue;
      for (const Index3& seen_through : LineOfSight(cloud.origin, echo)) {
        const Voxel v = absolute(seen_through, window_);
        if (hit.count(v) == 0) memory_.erase(v);
      }
    }
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

/// Heights in voxel edge lengths above the window's floor in the first scan.
class Donex2d {
 public:
  explicit Donex2d(const Config& config) : window_(config) {}

  using Cell = std::array<int, 2>;

  Labels process(const Scan& scan) { return process(Clouds{scan}); }

  /// Labels of all its clouds, one after the other.
  Labels process(const Clouds& turn) {
    window_.moveTo(turn.front().odom_from_base);
    if (window_.compensation() == Compensation::kScroll) {
      forgetOutside();
    } else {
      moveContents();
    }
    if (is_first_) floor_ = window_.minIndex().z();
    const auto lift = static_cast<float>(window_.minIndex().z() - floor_);

    Labels labels;
    std::map<Cell, HeightRange> own;
    std::vector<Cell> hit_in_order;
    for (const GridScan& cloud : entered(turn, window_)) {
      for (std::size_t i = 0; i < cloud.echoes.size(); ++i) {
        labels.push_back(0);
        if (cloud.inside[i] == 0) continue;
        const Voxel v = absolute(voxelOf(cloud.echoes[i]), window_);
        const Cell cell{v[0], v[1]};
        const float z = cloud.echoes[i].z() + lift;
        const auto remembered = ranges_.find(cell);
        const bool is_new = remembered == ranges_.end() || z < remembered->second.lo || z > remembered->second.hi;
        labels.back() = !is_first_ && is_new;
        if (own.count(cell) == 0) hit_in_order.push_back(cell);
        own[cell].extend(z);
      }
    }
    for (const auto& [cell, range] : own) ranges_[cell] = range;
    keepContents(own, hit_in_order);
    is_first_ = false;
    return labels;
  }

  const std::map<Cell, HeightRange>& memory() const { return ranges_; }
  const GridWindow& window() const { return window_; }

 private:
  /// An upright line that moves with the world between two scans of a resampled grid.
  struct Content2d {
    Eigen::Vector3d lo_in_odom, hi_in_odom;
    Cell cell;
  };

  void forgetOutside() {
    for (auto cell = ranges_.begin(); cell != ranges_.end();) {
      const Voxel v{cell->first[0], cell->first[1], window_.minIndex().z()};
      cell = inWindow(v, window_) ? std::next(cell) : ranges_.erase(cell);
    }
  }

  Eigen::Vector3d toWindow(const Eigen::Vector3d& in_odom) const {
    return window_.odomFromGrid().inverse() * in_odom / window_.voxelSize() - window_.minIndex().cast<double>();
  }
  Eigen::Vector3d fromWindow(double x, double y, double z) const {
    return window_.odomFromGrid() *
           ((Eigen::Vector3d(x, y, z) + window_.minIndex().cast<double>()) * window_.voxelSize());
  }

  void moveContents() {
    ranges_.clear();
    std::vector<Content2d> kept;
    for (Content2d content : contents_) {
      const Eigen::Vector3d lo = toWindow(content.lo_in_odom), hi = toWindow(content.hi_in_odom);
      const Eigen::Vector2d middle = 0.5 * (lo + hi).head<2>();
      const Index3 in_window(static_cast<int>(std::floor(middle.x())), static_cast<int>(std::floor(middle.y())), 0);
      if (!window_.contains(in_window)) continue;
      const Voxel v = absolute(in_window, window_);
      content.cell = {v[0], v[1]};
      const bool is_taken = ranges_.count(content.cell) != 0;
      HeightRange& range = ranges_[content.cell];
      range.extend(static_cast<float>(lo.z()));
      range.extend(static_cast<float>(hi.z()));
      if (!is_taken) {
        kept.push_back(content);
        continue;
      }
      for (Content2d& older : kept) {
        if (older.cell != content.cell) continue;
        const Eigen::Vector2d at = 0.5 * (toWindow(older.lo_in_odom) + toWindow(older.hi_in_odom)).head<2>();
        older.lo_in_odom = fromWindow(at.x(), at.y(), range.lo);
        older.hi_in_odom = fromWindow(at.x(), at.y(), range.hi);
      }
    }
    contents_ = kept;
  }

  void keepContents(const std::map<Cell, HeightRange>& hit, const std::vector<Cell>& hit_in_order) {
    std::vector<Content2d> kept;
    for (const Content2d& content : contents_) {
      if (hit.count(content.cell) == 0) kept.push_back(content);
    }
    for (const Cell& cell : hit_in_order) {
      const double x = cell[0] - window_.minIndex().x() + 0.5, y = cell[1] - window_.minIndex().y() + 0.5;
      const HeightRange& range = hit.at(cell);
      kept.push_back({fromWindow(x, y, range.lo), fromWindow(x, y, range.hi), cell});
    }
    contents_ = kept;
  }

  GridWindow window_;
  std::map<Cell, HeightRange> ranges_;
  std::vector<Content2d> contents_;
  int floor_ = 0;
  bool is_first_ = true;
};

/// The rule on parts: the turn so far, judged as the scan that its clouds make together.
template <class WholeScans>
class OfParts {
 public:
  explicit OfParts(const Config& config) : before_(config), now_(config) {}

  void beginTurn() {
    before_ = now_;
    turn_.clear();
  }
  /// Labels of the newest cloud.
  Labels take(const Scan& cloud) {
    turn_.push_back(cloud);
    now_ = before_;
    const Labels all = now_.process(turn_);
    return {all.end() - static_cast<std::ptrdiff_t>(cloud.echoes.size()), all.end()};
  }

  const WholeScans& wholeScans() const { return now_; }

 private:
  WholeScans before_, now_;
  Clouds turn_;
};

}  // namespace donex::oracle
