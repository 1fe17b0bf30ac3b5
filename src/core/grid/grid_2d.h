// The 2D grid's memory: a range of heights a cell (paper, 2D: ranging, previous range, resizing).
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid/cell_layout.h"
#include "core/grid/taken_echoes.h"
#include "core/grid/workers.h"

namespace donex {

/// The remembered ranges R of the algorithm ("The paper's rule in 2D"), heights in voxel edge lengths above the
/// window's floor level of the first scan. A turn is beginTurn, then take for each of its clouds; a whole scan is a
/// turn of one cloud.
class Grid2d {
 public:
  explicit Grid2d(const Config& config);

  /// Remembers the turn before (resizing): a cell that it hit takes its range, any other keeps its own. Then R': moves
  /// the ranges to the vehicle's new pose, heights included; what leaves the window is forgotten.
  void beginTurn(const Eigen::Isometry3d& odom_from_base);

  /// Judges a whole scan, or a part of the turn. `labels.dynamic` is 1 where an echo lies outside its cell's remembered
  /// range, `labels.observed` where the echo is inside the grid.
  void take(const Scan& scan, EchoLabels& labels);

  void reset();

  const GridWindow& window() const { return window_; }
  /// Numbers of the last cloud's invalid echoes (non-finite, too far).
  std::vector<std::uint32_t> noEchoes() const { return noEchoesOf(parts_); }
  /// Voxels of the last cloud's new echoes, in the window; a voxel may come more than once.
  std::vector<Index3> newVoxels() const { return newVoxelsOf(parts_); }
  /// What would be remembered of a cell of the window if the turn were over, heights as the window's.
  HeightRange rangeAt(int x, int y) const;
  std::size_t memoryBytes() const;
  /// What memoryBytes will be, for scans of so many echoes [bytes]. Contents that are resampled come on top.
  static double bytesFor(double slots, double echoes, int threads);

 private:
  struct Cell {
    HeightRange remembered;
    HeightRange taken;  ///< of the turn so far
  };
  /// What a cell's range stands for while contents are resampled: the upright line of its centre.
  struct Content {
    Eigen::Vector3d lo_in_odom, hi_in_odom;  ///< [m]
    std::uint32_t slot;
  };

  /// What one thread finds in its part of a cloud.
  struct Part {
    TakenEchoes echoes;
    /// The first hit_count: slots that were hit, in the order of their first echoes; the first part has the turn's.
    std::vector<std::uint32_t> hit;
    std::size_t hit_count = 0;
    std::vector<HeightRange> taken;  ///< by slot, as Cell::taken; the first part uses that

    void begin(std::size_t most_echoes);
  };

  void resample(const Eigen::Isometry3d& odom_from_base);
  void place(const Content& content, const Eigen::Isometry3d& grid_from_odom);
  template <class TakenOf>
  void judge(Part& part, std::size_t first, const EchoBlock& block, EchoLabels& labels, TakenOf&& taken_of);
  /// Adds what a part found to what the first one did.
  void takeOver(Part& part);
  void rememberTurn();
  void rememberContents();
  Eigen::Vector3d toWindow(const Eigen::Vector3d& in_grid) const;
  Eigen::Vector3d fromWindow(const Eigen::Vector3d& in_window) const;

  GridWindow window_;
  CellLayout layout_;
  std::vector<Cell> cells_;  ///< by slot; one more for the echoes outside
  Workers workers_;
  std::vector<Part> parts_;                     ///< one per thread
  std::vector<Content> contents_;               ///< resample: one per cell with a range
  std::vector<std::uint32_t> content_of_cell_;  ///< resample: while ranges are moved
};

}  // namespace donex
