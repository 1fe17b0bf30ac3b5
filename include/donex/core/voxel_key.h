// Voxels of an unbounded grid as keys of hash maps.
#pragma once

#include <cstdint>

#include "donex/core/line_of_sight.h"

namespace donex {

/// 21 bits an axis: indices from -2^20 to 2^20 - 1, at 0.2 m some 200 km to each side.
using VoxelKey = std::uint64_t;

inline VoxelKey keyOf(const Index3& voxel) {
  const auto part = [](int i) { return static_cast<VoxelKey>(i + (1 << 20)) & 0x1FFFFFU; };
  return part(voxel.x()) | part(voxel.y()) << 21U | part(voxel.z()) << 42U;
}

inline Index3 voxelOfKey(VoxelKey key) {
  const auto part = [](VoxelKey bits) { return static_cast<int>(bits & 0x1FFFFFU) - (1 << 20); };
  return {part(key), part(key >> 21U), part(key >> 42U)};
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
