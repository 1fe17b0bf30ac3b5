// The 2D grid's memory: a range of heights a cell (paper, 2D: ranging, previous range, resizing).
#pragma once

#include <cstdint>
#include <vector>

#include "donex/core/cell_layout.h"

namespace donex {

/// The remembered ranges R_k of algorithm section 2, heights in voxel edge lengths above the window's
/// floor level of the first scan. A scan is shift, then take.
class Grid2d {
 public:
  explicit Grid2d(const Config& config);

  /// R': moves the ranges to the vehicle's new pose, heights included; what leaves the window is forgotten.
  void shift(const Eigen::Isometry3d& odom_from_base);

  /// Judges a scan and remembers it. `labels.dynamic` is 1 where an echo lies outside its cell's remembered range,
  /// `labels.observed` where the echo is inside the grid. Then (resizing) a hit cell takes the scan's own range, any
  /// other keeps its own.
  void take(const Scan& scan, EchoLabels& labels);

  void reset();

  const GridWindow& window() const { return window_; }
  /// Numbers of the last scan's echoes that are none (non-finite, too far).
  const std::vector<std::uint32_t>& noEchoes() const { return no_echoes_; }
  /// Voxels of the last scan's new echoes, in the window; a voxel may come more than once.
  std::vector<Index3> newVoxels() const {
    return {new_voxels_.begin(), new_voxels_.begin() + static_cast<std::ptrdiff_t>(new_count_)};
  }
  /// Remembered range of a cell of the window, heights as the window's.
  HeightRange rangeAt(int x, int y) const;
  std::size_t memoryBytes() const;
  /// What memoryBytes will be, for scans of so many echoes [bytes]. Contents that are resampled come on top.
  static double bytesFor(double slots, double echoes) {
    return slots * sizeof(Cell) + echoes * (sizeof(Index3) + sizeof(std::uint32_t));
  }

 private:
  struct Cell {
    HeightRange range;
    HeightRange before;      ///< the range that the scan which last hit the cell found
    std::uint32_t scan = 0;  ///< that scan
  };
  /// What a cell's range stands for while contents are resampled: the upright line of its centre.
  struct Content {
    Eigen::Vector3d lo_in_odom, hi_in_odom;  ///< [m]
    std::uint32_t slot;
  };

  void resample(const Eigen::Isometry3d& odom_from_base);
  void place(const Content& content, const Eigen::Isometry3d& grid_from_odom);
  template <bool keep_order>
  void judge(std::size_t first, const EchoBlock& block, EchoLabels& labels);
  void rememberContents();
  Eigen::Vector3d toWindow(const Eigen::Vector3d& in_grid) const;
  Eigen::Vector3d fromWindow(const Eigen::Vector3d& in_window) const;

  GridWindow window_;
  CellLayout layout_;
  std::uint32_t scan_ = 0;
  std::vector<Cell> cells_;         ///< by slot; one more for the echoes outside
  std::vector<Index3> new_voxels_;  ///< the first new_count_ of them
  std::size_t new_count_ = 0;
  std::vector<std::uint32_t> no_echoes_;
  std::vector<Content> contents_;               ///< resample: one a cell with a range
  std::vector<std::uint32_t> content_of_cell_;  ///< resample: while ranges are moved
  std::vector<std::uint32_t> hit_;              ///< resample: slots the scan hit, in the order of their first echoes
};

}  // namespace donex
