// Voxels of an unbounded grid as keys of hash maps.
#pragma once

#include <cstdint>

#include "core/grid/line_of_sight.h"

namespace donex {

/// 21 bits an axis: unique within 2^21 voxels, at 0.2 m some 400 km; farther indices share keys.
using VoxelKey = std::uint64_t;

inline VoxelKey keyOf(const Index3& voxel) {
  const auto part = [](int i) { return static_cast<VoxelKey>(i + (1 << 20)) & 0x1FFFFFU; };
  return part(voxel.x()) | part(voxel.y()) << 21U | part(voxel.z()) << 42U;
}

/// The voxel of that key which lies less than 2^20 voxels from `near` along each axis.
inline Index3 voxelOfKey(VoxelKey key, const Index3& near) {
  const auto part = [](VoxelKey bits, int around) {
    const auto ahead = static_cast<int>((bits - static_cast<VoxelKey>(around)) & 0x1FFFFFU);  // 0 to 2^21 - 1
    return around - (1 << 20) + ahead;
  };
  return {part(key, near.x()), part(key >> 21U, near.y()), part(key >> 42U, near.z())};
}

/// Neighbouring voxels differ in few bits, so the bits are mixed (the finaliser of MurmurHash3).
struct VoxelHash {
  std::size_t operator()(VoxelKey key) const {
    key = (key ^ key >> 33U) * 0xFF51AFD7ED558CCDULL;
    key = (key ^ key >> 33U) * 0xC4CEB9FE1A85EC53ULL;
    return static_cast<std::size_t>(key ^ key >> 33U);
  }
};

}  // namespace donex
