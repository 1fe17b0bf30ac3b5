// Echoes in blocks, coordinate by coordinate: how the fast loops want them.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace donex {

/// Where a scan lies in the grid's window, in single precision.
struct Placement {
  Eigen::Matrix3f rotation;                             ///< sensor frame [m] to the window's axes [voxels]
  Eigen::Vector3f origin;                               ///< sensor, in the window [voxels]
  Eigen::Vector3f extent;                               ///< of the window [voxels]
  Eigen::Matrix3f mounting;                             ///< sensor frame to vehicle frame
  Eigen::Vector3f mounted_at, region_low, region_high;  ///< vehicle frame [m]

  /// One echo of the scan in the window; rounds as EchoBlock does.
  Eigen::Vector3f toWindow(const Eigen::Vector3f& echo) const;
};

/// Some neighbouring echoes of a scan in the window.
struct EchoBlock {
  static constexpr int kSize = 256;
  template <class Number>
  using Row = std::array<Number, kSize>;

  int none = 0;                    ///< how many of the entries are invalid
  int count = 0;                   ///< what is behind holds no echo: NaN, not inside
  alignas(64) Row<float> x, y, z;  ///< [voxels]; NaN for invalid echoes (non-finite, too far)
  /// 1 inside the region of interest and the window, the echo hits the grid; else 0.
  alignas(64) Row<std::int32_t> inside;
  alignas(64) Row<std::uint8_t> observed;                   ///< the same as bytes
  alignas(64) Row<std::int32_t> voxel_x, voxel_y, voxel_z;  ///< 0 where not inside

  Eigen::Vector3i voxel(int i) const { return {voxel_x[i], voxel_y[i], voxel_z[i]}; }

  /// Appends the numbers of the entries that are no echo; the first entry is number `first`.
  void appendNoEchoes(std::size_t first, std::vector<std::uint32_t>& numbers) const;

  /// Takes `echoes` (at most kSize) in the sensor frame [m].
  void place(const Placement& placement, const Eigen::Vector3f* echoes, int echoes_count);
};

/// Cells that are to be looked up, by echo of a block: which place in memory, and which bit of it.
struct BlockSlots {
  alignas(64) EchoBlock::Row<std::uint32_t> slot;
  alignas(64) EchoBlock::Row<std::uint32_t> bit;
};

/// Shows `visit(first, block)` blocks `first_block` to `last_block` (not included) of the echoes, in order.
template <class Visit>
void forEachBlock(const Placement& placement, const std::vector<Eigen::Vector3f>& echoes, std::size_t first_block,
                  std::size_t last_block, Visit&& visit) {
  EchoBlock block;
  for (std::size_t i = first_block; i < last_block; ++i) {
    const std::size_t first = i * EchoBlock::kSize;
    const std::size_t count = std::min<std::size_t>(EchoBlock::kSize, echoes.size() - first);
    block.place(placement, echoes.data() + first, static_cast<int>(count));
    visit(first, block);
  }
}

inline std::size_t blocksOf(std::size_t echoes) { return (echoes + EchoBlock::kSize - 1) / EchoBlock::kSize; }

/// Where part `part` of `parts` neighbouring parts of so many blocks begins; it ends where the next one begins.
inline std::size_t firstBlockOf(std::size_t part, std::size_t parts, std::size_t blocks) {
  return blocks * part / parts;
}

}  // namespace donex
