// The 3D grid's memory: which voxels still carry an identifier (paper, 3D: shadowing, de-shadowing).
#pragma once

#include <vector>

#include "donex/core/brick_mask.h"
#include "donex/core/grid_window.h"
#include "donex/core/ray_index.h"

namespace donex {

/// M_k of algorithm section 1, in the window's coordinates. Steps are called in the paper's order:
/// shift, hit, (is an echo's voxel remembered?), deshadow, remember.
class Grid3d {
 public:
  explicit Grid3d(const Config& config);

  /// M' = shift(M_{k-1}): moves the memory to the vehicle's new pose; what leaves the window is forgotten.
  void shift(const Eigen::Isometry3d& odom_from_base);

  /// H_k: marks the voxels that the scan's inside echoes hit.
  void hit(const GridScan& scan);

  /// v in M': call before remember.
  bool remembers(const Index3& in_window) const { return remembered_.test(layout_.locate(in_window)); }

  bool isHit(const Index3& in_window) const { return hit_.test(layout_.locate(in_window)); }

  /// Forgets what is remembered, not hit now, and crossed by a line of sight of the scan before its end.
  void deshadow(const GridScan& scan);

  /// The same for another notion of see-through: `sees_through(voxel)`, asked of what is remembered and not hit now.
  template <class Predicate>
  void deshadowWhere(Predicate&& sees_through) {
    remembered_.transform([&](std::uint32_t slot, std::uint64_t word) {
      const Index3 corner = layout_.cornerOf(slot);
      for (std::uint64_t candidates = word & ~hit_.word(slot); candidates != 0; candidates &= candidates - 1) {
        const int bit = __builtin_ctzll(candidates);
        if (sees_through(BrickLayout::voxelOfBit(corner, bit))) word &= ~(std::uint64_t{1} << bit);
      }
      return word;
    });
  }

  /// M_k = H_k u M'.
  void remember();

  void reset();

  const GridWindow& window() const { return window_; }
  /// Remembered voxels, in the window; order is not specified.
  std::vector<Index3> remembered() const;
  std::size_t memoryBytes() const;

 private:
  /// What a remembered voxel stands for while its contents are resampled: a point that moves with the world.
  struct Content {
    Eigen::Vector3d in_odom;  ///< [m]; kept in the odometry frame, so no error gathers over many shifts
    BrickBit at;
  };

  void scroll(const Eigen::Isometry3d& odom_from_base);
  void resample(const Eigen::Isometry3d& odom_from_base);
  void rememberContents();

  GridWindow window_;
  BrickLayout layout_;
  BrickMask remembered_, hit_;
  RayIndex rays_;
  std::vector<Content> contents_;      ///< resample: one a remembered voxel
  std::vector<Index3> hit_voxels_;     ///< resample: in the order of their first echoes
};

}  // namespace donex
