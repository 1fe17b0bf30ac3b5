// A scan's echoes spread evenly in space: one in each voxel.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/grid/voxel_key.h"

namespace donex {

/// Picks the first echo of each voxel. Keeps its memory.
class EchoThinning {
 public:
  /// Appends to `picked` the indices, of those in `candidates`, of the first echo in each voxel of `edge` [m].
  void pick(const std::vector<Eigen::Vector3f>& echoes, const std::vector<std::uint32_t>& candidates, float edge,
            std::vector<std::uint32_t>& picked);

  std::size_t memoryBytes() const { return tags_.capacity() * sizeof(std::uint32_t); }

 private:
  std::vector<std::uint32_t> tags_;  // a hash table; two voxels of one tag lose an echo, which does no harm
};

}  // namespace donex
