// The cells of a 2D grid in a window that wraps around, and heights that outlast its moves.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/grid/grid_window.h"

namespace donex {

/// [lo, hi] of the heights in a cell; empty where lo > hi (paper, 2D: ranging).
struct HeightRange {
  float lo = std::numeric_limits<float>::infinity();
  float hi = -std::numeric_limits<float>::infinity();

  bool empty() const { return lo > hi; }
  bool holds(float z) const { return z >= lo && z <= hi; }
  void extend(float z) {
    lo = std::min(lo, z);
    hi = std::max(hi, z);
  }
  void extend(const HeightRange& other) {
    lo = std::min(lo, other.lo);
    hi = std::max(hi, other.hi);
  }
};

class CellLayout {
 public:
  explicit CellLayout(const GridWindow& window) : width_(window.extent().x()), depth_(window.extent().y()) {}

  std::size_t slots() const { return static_cast<std::size_t>(width_) * static_cast<std::size_t>(depth_); }

  /// Slot of a cell of the window; the same cell of the world keeps it while the window scrolls.
  std::uint32_t slotOf(int x, int y) const {
    return static_cast<std::uint32_t>(wrapped(y + shift_y_, depth_) * width_ + wrapped(x + shift_x_, width_));
  }
  /// The slots of a block's inside echoes; the others get the slot behind the last.
  void locate(const EchoBlock& block, BlockSlots& result) const;

  Index3 cellOf(std::uint32_t slot) const {
    const int i = static_cast<int>(slot);
    return {modulo(i % width_ - shift_x_, width_), modulo(i / width_ - shift_y_, depth_), 0};
  }

  /// Added to a height in the window, it gives heightOf [voxels].
  float lift() const { return static_cast<float>(lift_); }

  /// Height [voxels] of a point of the window above the window's floor in the first scan: it stays
  /// comparable while the window scrolls up and down.
  float heightOf(const Eigen::Vector3f& in_window) const { return in_window.z() + lift(); }

  /// Moves the window; `forget(slot)` is called for every cell that has just entered it.
  template <class Forget>
  void scroll(GridWindow& window, const Eigen::Isometry3d& odom_from_base, Forget&& forget) {
    const Index3 before = window.minIndex();
    window.moveTo(odom_from_base);
    const Index3 moved = window.minIndex() - before;
    lift_ = is_first_ ? 0 : lift_ + moved.z();
    is_first_ = false;
    shift_x_ = modulo(window.minIndex().x(), width_);
    shift_y_ = modulo(window.minIndex().y(), depth_);
    forgetEntered(moved.x(), moved.y(), forget);
  }

  void reset() { is_first_ = true; }

 private:
  template <class Forget>
  void forgetEntered(int moved_x, int moved_y, Forget& forget) {
    const int x_first = moved_x > 0 ? std::max(0, width_ - moved_x) : 0;
    const int x_end = moved_x > 0 ? width_ : std::min(width_, -moved_x);
    for (int y = 0; y < depth_; ++y) {
      const bool row_entered = y + moved_y < 0 || y + moved_y >= depth_;
      const int first = row_entered ? 0 : x_first;
      const int end = row_entered ? width_ : x_end;
      for (int x = first; x < end; ++x) forget(slotOf(x, y));
    }
  }

  int width_, depth_;              ///< cells
  int shift_x_ = 0, shift_y_ = 0;  ///< slot of the window's lowest cell
  int lift_ = 0;                   ///< how far the window's floor has risen since the first scan [voxels]
  bool is_first_ = true;
};

}  // namespace donex
