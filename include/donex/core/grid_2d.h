// The 2D grid's memory: a range of heights a cell (paper, 2D: ranging, previous range, resizing).
#pragma once

#include <cstdint>
#include <vector>

#include "donex/core/cell_layout.h"

namespace donex {

/// The remembered ranges R_k of algorithm section 2, heights in voxel edge lengths above the window's
/// floor level of the first scan. Steps are called in the paper's order: shift, (does the range hold the echo?), resize.
class Grid2d {
 public:
  explicit Grid2d(const Config& config);

  /// R': moves the ranges to the vehicle's new pose, heights included; what leaves the window is forgotten.
  void shift(const Eigen::Isometry3d& odom_from_base);

  /// True where the remembered range of the echo's cell holds its height. `echo` in the window, inside it.
  bool remembers(const Eigen::Vector3f& echo) const { return cells_[slotOf(echo)].range.holds(layout_.heightOf(echo)); }

  /// Resizing: a hit cell takes the scan's own range, any other keeps its own.
  void resize(const GridScan& scan);

  void reset();

  const GridWindow& window() const { return window_; }
  /// Remembered range of a cell of the window, heights as the window's.
  HeightRange rangeAt(int x, int y) const;
  std::size_t memoryBytes() const;

 private:
  struct Cell {
    HeightRange range;
    std::uint32_t scan = 0;     ///< the scan that last hit the cell
    std::uint32_t content = 0;  ///< resample: its content, while ranges are moved
  };
  /// What a cell's range stands for while contents are resampled: the upright line of its centre.
  struct Content {
    Eigen::Vector3d lo_in_odom, hi_in_odom;  ///< [m]
    std::uint32_t slot;
  };

  void resample(const Eigen::Isometry3d& odom_from_base);
  void place(const Content& content, const Eigen::Isometry3d& grid_from_odom);
  void rememberContents();
  Eigen::Vector3d toWindow(const Eigen::Vector3d& in_grid) const;
  Eigen::Vector3d fromWindow(const Eigen::Vector3d& in_window) const;
  std::uint32_t slotOf(const Eigen::Vector3f& echo) const;

  GridWindow window_;
  CellLayout layout_;
  std::uint32_t scan_ = 0;
  std::vector<Cell> cells_;
  std::vector<Content> contents_;    ///< resample: one a cell with a range
  std::vector<std::uint32_t> hit_;   ///< resample: slots the scan hit, in the order of their first echoes
};

}  // namespace donex
