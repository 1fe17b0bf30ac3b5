// Where a block's echoes lie in the memory of either grid.
#include "core/grid/brick_layout.h"
#include "core/grid/cell_layout.h"
#include "core/grid/simd.h"

namespace donex {
namespace {

/// What the loops below need of a layout: the extent in cells or bricks, and where its lowest one lies.
struct Wrap {
  int width, depth, height;
  int shift_x, shift_y, shift_z;
};

DONEX_WIDE_LOOPS void locateCells(const Wrap& layout, const EchoBlock& block, BlockSlots& result) {
  const Wrap w = layout;
  const int none = w.width * w.depth;
  for (int i = 0; i < EchoBlock::kSize; ++i) {
    const int x = wrapped(block.voxel_x[i] + w.shift_x, w.width), y = wrapped(block.voxel_y[i] + w.shift_y, w.depth);
    result.slot[i] = static_cast<std::uint32_t>(block.inside[i] != 0 ? y * w.width + x : none);
  }
}

DONEX_WIDE_LOOPS void locateBits(const Wrap& layout, const EchoBlock& block, BlockSlots& result) {
  const Wrap w = layout;
  const int none = w.width * w.depth * w.height;
  for (int i = 0; i < EchoBlock::kSize; ++i) {
    const int x = block.voxel_x[i], y = block.voxel_y[i], z = block.voxel_z[i];
    const int brick_x = wrapped((x >> 2) + w.shift_x, w.width), brick_y = wrapped((y >> 2) + w.shift_y, w.depth);
    const int brick_z = wrapped((z >> 2) + w.shift_z, w.height);
    const int slot = (brick_z * w.depth + brick_y) * w.width + brick_x;
    result.slot[i] = static_cast<std::uint32_t>(block.inside[i] != 0 ? slot : none);
    result.bit[i] = static_cast<std::uint32_t>((x & 3) | (y & 3) << 2 | (z & 3) << 4);
  }
}

}  // namespace

void CellLayout::locate(const EchoBlock& block, BlockSlots& result) const {
  locateCells({width_, depth_, 1, shift_x_, shift_y_, 0}, block, result);
}

void BrickLayout::locate(const EchoBlock& block, BlockSlots& result) const {
  locateBits({bricks_.x(), bricks_.y(), bricks_.z(), shift_.x(), shift_.y(), shift_.z()}, block, result);
}

}  // namespace donex
