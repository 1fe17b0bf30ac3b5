// De-shadowing by a z-buffer instead of a traversal: the alternative that the paper set aside.
#pragma once

#include "core/grid/brick_layout.h"
#include "core/grid/workers.h"
#include "core/sight/range_image.h"

namespace donex {

/// See-through asked of a z-buffer (after Hu & Li 2012, as the paper cites them), for Grid3d: the scan is rendered into
/// an image of nearest ranges, and a remembered voxel is see-through where the image shows a surface behind it, by more
/// than the half diagonal of a voxel. One look-up per voxel; a pixel with a nearer echo, or without one, hides what a
/// single line of sight between two pixels' echoes would have seen.
class ZBuffer {
 public:
  static constexpr bool kParallel = false;

  void begin(const Placement& placement, const std::vector<Eigen::Vector3f>&, std::size_t) {
    origin_ = placement.origin;
    image_.clear();
  }
  void add(std::size_t, std::size_t, const EchoBlock& block) {
    for (int i = 0; i < block.count; ++i) image_.add(Eigen::Vector3f(block.x[i], block.y[i], block.z[i]) - origin_);
  }
  void finish(const Workers&) {}

  std::uint64_t seenThrough(std::uint64_t candidates, const Index3& corner) const {
    std::uint64_t seen = 0;
    for (; candidates != 0; candidates &= candidates - 1) {
      const int bit = __builtin_ctzll(candidates);
      if (seesThrough(BrickLayout::voxelOfBit(corner, bit))) seen |= std::uint64_t{1} << bit;
    }
    return seen;
  }

  void reset() { image_.clear(); }
  std::size_t memoryBytes() const { return image_.memoryBytes(); }

 private:
  static constexpr float kHalfDiagonal = 0.8660254F;  // of a voxel [voxels]

  bool seesThrough(const Index3& voxel) const {
    const Eigen::Vector3f center = voxel.cast<float>() + Eigen::Vector3f::Constant(0.5F) - origin_;
    return image_.rangeTowards(center) > center.norm() + kHalfDiagonal;
  }

  Eigen::Vector3f origin_ = Eigen::Vector3f::Zero();  ///< sensor, in the window [voxels]
  RangeImage image_;
};

}  // namespace donex
