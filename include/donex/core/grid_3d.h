// The 3D grid's memory: which voxels still carry an identifier (paper, 3D: shadowing, de-shadowing).
#pragma once

#include <vector>

#include "donex/core/brick_layout.h"
#include "donex/core/grid_window.h"
#include "donex/core/ray_index.h"

namespace donex {

/// M_k of algorithm section 1, in the window's coordinates. A scan is shift, then take.
class Grid3d {
 public:
  explicit Grid3d(const Config& config);

  /// M' = shift(M_{k-1}): moves the memory to the vehicle's new pose; what leaves the window is forgotten.
  void shift(const Eigen::Isometry3d& odom_from_base);

  /// Judges a scan and remembers it. `labels.dynamic` is 1 where an echo's voxel is hit and not remembered (H_k \ M'),
  /// `labels.observed` where the echo is inside the grid. Then M_k = H_k u { v in M' : v not seen through }.
  void take(const Scan& scan, EchoLabels& labels);

  void reset();

  const GridWindow& window() const { return window_; }
  /// Numbers of the last scan's echoes that are none (non-finite, too far).
  const std::vector<std::uint32_t>& noEchoes() const { return no_echoes_; }
  /// Voxels of the last scan's new echoes, in the window; a voxel may come more than once.
  std::vector<Index3> newVoxels() const {
    return {new_voxels_.begin(), new_voxels_.begin() + static_cast<std::ptrdiff_t>(new_count_)};
  }
  /// Remembered voxels, in the window; order is not specified.
  std::vector<Index3> remembered() const;
  std::size_t memoryBytes() const;

 protected:
  /// The first half of take: marks H_k and judges.
  void hit(const Scan& scan, EchoLabels& labels);
  /// The second: M_k = H_k u { v in M' \ H_k : v not seen through }. `seen(candidates, corner)` says which of a brick's
  /// candidates are, as bits of the voxels from `corner` upwards.
  template <class Seen>
  void remember(Seen&& seen);

 private:
  struct Brick {
    std::uint64_t remembered = 0, hit = 0;  ///< a bit a voxel
  };
  /// A brick that holds anything.
  struct Used {
    std::uint32_t slot;
    Index3 corner;  ///< its lowest voxel, in the grid's frame
  };
  /// What a remembered voxel stands for while its contents are resampled: a point that moves with the world.
  struct Content {
    Eigen::Vector3d in_odom;  ///< [m]; kept in the odometry frame, so no error gathers over many shifts
    BrickBit at;
  };

  void scroll(const Eigen::Isometry3d& odom_from_base);
  void resample(const Eigen::Isometry3d& odom_from_base);
  template <bool keep_order>
  void hit(std::size_t first, const EchoBlock& block, EchoLabels& labels);
  void forgetHitContents();
  void rememberContents();
  Brick& brickAt(std::uint32_t slot, const Index3& in_window);
  void clearBricks();

  GridWindow window_;
  BrickLayout layout_;
  std::vector<Brick> bricks_;  ///< by slot; one more for the echoes outside
  std::vector<Used> used_;     ///< each once
  RayIndex rays_;
  std::vector<Index3> new_voxels_;  ///< the first new_count_ of them
  std::size_t new_count_ = 0;
  std::vector<std::uint32_t> no_echoes_;
  std::vector<Content> contents_;    ///< resample: one a remembered voxel
  std::vector<Index3> hit_voxels_;   ///< resample: in the order of their first echoes
};

template <class Seen>
void Grid3d::remember(Seen&& seen) {
  constexpr std::size_t kAhead = 12;  // bricks are asked of memory so long before they are needed
  forgetHitContents();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < used_.size(); ++i) {
    if (i + kAhead < used_.size()) __builtin_prefetch(&bricks_[used_[i + kAhead].slot], 1);
    const Used& used = used_[i];
    Brick& brick = bricks_[used.slot];
    const std::uint64_t candidates = brick.remembered & ~brick.hit;
    const std::uint64_t forgotten = candidates == 0 ? 0 : seen(candidates, used.corner - window_.minIndex());
    brick.remembered = (brick.remembered & ~forgotten) | brick.hit;
    brick.hit = 0;
    if (brick.remembered != 0) used_[kept++] = used;
  }
  used_.resize(kept);
  rememberContents();
}

}  // namespace donex
