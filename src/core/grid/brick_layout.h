// Voxels in bricks of 4 x 4 x 4, a bit each of a 64-bit word, in a window that wraps around.
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid/grid_window.h"

namespace donex {

/// The place of a voxel: its brick's slot and its bit there.
struct BrickBit {
  std::uint32_t slot;
  std::uint32_t bit;
};

/// Maps the voxels of a window to slots that stay the same while the window scrolls: index modulo extent.
class BrickLayout {
 public:
  explicit BrickLayout(const Index3& extent) : bricks_(extent / GridWindow::kBrick), shift_(Index3::Zero()) {}

  /// The window's lowest voxel has moved to `min_index` (multiples of GridWindow::kBrick).
  void scrollTo(const Index3& min_index) {
    for (int axis = 0; axis < 3; ++axis) shift_[axis] = modulo(min_index[axis] / GridWindow::kBrick, bricks_[axis]);
  }

  std::size_t slots() const { return static_cast<std::size_t>(bricks_.cast<std::int64_t>().prod()); }

  BrickBit locate(const Index3& in_window) const {
    const int bit = (in_window.x() & 3) | (in_window.y() & 3) << 2 | (in_window.z() & 3) << 4;
    return {slotOf(in_window.x() >> 2, in_window.y() >> 2, in_window.z() >> 2), static_cast<std::uint32_t>(bit)};
  }

  /// The places of a block's inside echoes; the others get the slot behind the last.
  void locate(const EchoBlock& block, BlockSlots& result) const;

  /// Lowest voxel of the brick in `slot`, in the window.
  Index3 cornerOf(std::uint32_t slot) const {
    const int i = static_cast<int>(slot);
    Index3 brick(i % bricks_.x(), i / bricks_.x() % bricks_.y(), i / bricks_.x() / bricks_.y());
    brick -= shift_;
    for (int axis = 0; axis < 3; ++axis) {
      if (brick[axis] < 0) brick[axis] += bricks_[axis];
    }
    return brick * GridWindow::kBrick;
  }

  static Index3 voxelOfBit(const Index3& corner, int bit) { return corner + Index3(bit & 3, bit >> 2 & 3, bit >> 4); }

 private:
  std::uint32_t slotOf(int x, int y, int z) const {
    x = wrapped(x + shift_.x(), bricks_.x());
    y = wrapped(y + shift_.y(), bricks_.y());
    z = wrapped(z + shift_.z(), bricks_.z());
    return static_cast<std::uint32_t>((z * bricks_.y() + y) * bricks_.x() + x);
  }

  Index3 bricks_;
  Index3 shift_;
};

}  // namespace donex
