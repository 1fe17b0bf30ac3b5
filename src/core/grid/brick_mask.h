// A set of voxels as bits.
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid/brick_layout.h"

namespace donex {

/// The bits of a set of voxels, and which bricks hold any.
class BrickMask {
 public:
  explicit BrickMask(std::size_t slots) : words_(slots, 0) {}

  std::uint64_t word(std::uint32_t slot) const { return words_[slot]; }
  bool test(BrickBit at) const { return (words_[at.slot] >> at.bit & 1U) != 0; }

  void set(BrickBit at) {
    if (words_[at.slot] == 0) used_.push_back(at.slot);
    words_[at.slot] |= std::uint64_t{1} << at.bit;
  }

  void clear() {
    for (const std::uint32_t slot : used_) words_[slot] = 0;
    used_.clear();
  }

  const std::vector<std::uint32_t>& used() const { return used_; }
  std::size_t bytes() const { return words_.capacity() * sizeof(words_[0]) + used_.capacity() * sizeof(used_[0]); }

 private:
  std::vector<std::uint64_t> words_;
  std::vector<std::uint32_t> used_;  ///< slots of the words that are not zero, each once
};

}  // namespace donex
