// De-shadowing by a z-buffer instead of a traversal: the alternative that the paper set aside.
#pragma once

#include "core/grid/grid_3d.h"
#include "core/sight/range_image.h"

namespace donex {

/// The 3D grid whose see-through is asked of a z-buffer (after Hu & Li 2012, as the paper cites them): the scan is
/// rendered into an image of nearest ranges, and a remembered voxel is see-through where the image shows a surface
/// behind it. One look-up per voxel; a pixel with a nearer echo, or without one, hides what a single line of sight
/// between two pixels' echoes would have seen.
class ZBufferGrid : public Grid3d {
 public:
  /// Works on one thread.
  explicit ZBufferGrid(const Config& config) : Grid3d(onOneThread(config)) {}

  /// As Grid3d::take, but forgets what is remembered, not hit now, and nearer than the surface of its direction by more
  /// than the half diagonal of a voxel.
  void take(const Scan& scan, EchoLabels& labels) {
    const Placement placement = window().placementOf(scan);
    image_.clear();
    hit(scan, placement, labels, [&](std::size_t, std::size_t, const EchoBlock& block) {
      for (int i = 0; i < block.count; ++i) {
        image_.add(Eigen::Vector3f(block.x[i], block.y[i], block.z[i]) - placement.origin);
      }
    });
    remember([&](std::uint64_t candidates, const Index3& corner) {
      std::uint64_t seen = 0;
      for (; candidates != 0; candidates &= candidates - 1) {
        const int bit = __builtin_ctzll(candidates);
        if (seesThrough(BrickLayout::voxelOfBit(corner, bit), placement.origin)) seen |= std::uint64_t{1} << bit;
      }
      return seen;
    });
  }

  std::size_t memoryBytes() const { return Grid3d::memoryBytes() + image_.memoryBytes(); }

 private:
  static Config onOneThread(Config config) {
    config.threads = 1;
    return config;
  }
  bool seesThrough(const Index3& voxel, const Eigen::Vector3f& origin) const {
    const Eigen::Vector3f center = voxel.cast<float>() + Eigen::Vector3f::Constant(0.5F) - origin;
    return image_.rangeTowards(center) > center.norm() + kHalfDiagonal;
  }

  static constexpr float kHalfDiagonal = 0.8660254F;  // of a voxel [voxels]

  RangeImage image_;
};

}  // namespace donex
