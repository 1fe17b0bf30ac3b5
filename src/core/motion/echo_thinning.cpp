#include "core/motion/echo_thinning.h"

#include <algorithm>
#include <cmath>

namespace donex {
void EchoThinning::pick(const std::vector<Eigen::Vector3f>& echoes, const std::vector<std::uint32_t>& candidates,
                        float edge, std::vector<std::uint32_t>& picked) {
  std::size_t slots = 1024;
  while (slots < 2 * candidates.size()) slots *= 2;
  tags_.assign(slots, 0);
  const std::size_t mask = slots - 1;
  const float scale = 1.0F / edge;
  VoxelKey previous = ~VoxelKey{0};  // keys have 63 bits
  for (const std::uint32_t i : candidates) {
    const Eigen::Array3f scaled = (echoes[i].array() * scale).floor();
    const VoxelKey key = keyOf(scaled.cast<int>().matrix());
    if (key == previous) continue;  // most often, along a ring
    previous = key;
    const std::size_t hash = VoxelHash()(key);
    const auto tag = static_cast<std::uint32_t>(hash >> 32U) | 1U;
    std::size_t slot = hash & mask;
    while (tags_[slot] != tag && tags_[slot] != 0) slot = (slot + 1) & mask;
    if (tags_[slot] == tag) continue;
    tags_[slot] = tag;
    picked.push_back(i);
  }
}

}  // namespace donex
