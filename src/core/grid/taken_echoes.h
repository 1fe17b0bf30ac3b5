// What a grid keeps of the echoes it has judged, besides their labels.
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid/echo_block.h"
#include "core/grid/line_of_sight.h"

namespace donex {

/// Of one part of a scan. Storage is kept from scan to scan.
class TakenEchoes {
 public:
  /// A part of at most so many echoes begins.
  void begin(std::size_t echoes) {
    new_count_ = 0;
    if (new_voxels_.size() < echoes) new_voxels_.resize(echoes);
    no_echoes_.clear();
    no_echoes_.reserve(echoes);
  }

  /// Takes a block whose first echo is number `first`; `new_echoes`: which of its entries are new.
  void add(std::size_t first, const EchoBlock& block, const int* new_echoes, int new_count) {
    block.appendNoEchoes(first, no_echoes_);
    for (int i = 0; i < new_count; ++i) new_voxels_[new_count_++] = block.voxel(new_echoes[i]);
  }

  /// Appends the voxels of the new echoes, in the window; a voxel may come more than once.
  void appendNewVoxels(std::vector<Index3>& voxels) const {
    voxels.insert(voxels.end(), new_voxels_.begin(), new_voxels_.begin() + static_cast<std::ptrdiff_t>(new_count_));
  }
  /// Appends the numbers of the invalid echoes (non-finite, too far).
  void appendNoEchoes(std::vector<std::uint32_t>& numbers) const {
    numbers.insert(numbers.end(), no_echoes_.begin(), no_echoes_.end());
  }

  void clear() {
    new_count_ = 0;
    no_echoes_.clear();
  }

  std::size_t memoryBytes() const {
    return new_voxels_.capacity() * sizeof(Index3) + no_echoes_.capacity() * sizeof(std::uint32_t);
  }
  /// What memoryBytes will be, for so many echoes [bytes].
  static double bytesFor(double echoes) { return echoes * (sizeof(Index3) + sizeof(std::uint32_t)); }

 private:
  std::vector<Index3> new_voxels_;  ///< the first new_count_ of them
  std::size_t new_count_ = 0;
  std::vector<std::uint32_t> no_echoes_;
};

/// The new voxels of all parts of a scan (each with its `echoes`), as TakenEchoes says.
template <class Part>
std::vector<Index3> newVoxelsOf(const std::vector<Part>& parts) {
  std::vector<Index3> voxels;
  for (const Part& part : parts) part.echoes.appendNewVoxels(voxels);
  return voxels;
}

/// The same of the invalid echoes.
template <class Part>
std::vector<std::uint32_t> noEchoesOf(const std::vector<Part>& parts) {
  std::vector<std::uint32_t> numbers;
  for (const Part& part : parts) part.echoes.appendNoEchoes(numbers);
  return numbers;
}

}  // namespace donex
