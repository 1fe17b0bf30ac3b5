// The paper's rule in 3D (paper, 3D: new echoes, shadowing, de-shadowing), on whole scans and on parts.
#pragma once

#include "core/grid/voxel_memory.h"

namespace donex {

/// `SeeThrough` says which remembered voxels a cloud sees through:
///   kParallel                                may be filled and asked by several threads
///   begin(placement, echoes, parts)          a cloud begins, in so many parts
///   add(part, first, block)                  a block of a part; its first echo is number `first` of the cloud
///   finish(workers)                          all blocks are there
///   seenThrough(candidates, corner)          those of a brick's candidates that are, as bits of the voxels from
///   `corner` reset(), memoryBytes()
template <class SeeThrough>
class Grid3d {
 public:
  explicit Grid3d(const Config& config) : memory_(SeeThrough::kParallel ? config : onOneThread(config)) {}

  /// A turn begins at this pose of the vehicle, as VoxelMemory::beginTurn says.
  void beginTurn(const Eigen::Isometry3d& odom_from_base) { memory_.beginTurn(odom_from_base); }

  /// Judges a whole scan, or a part of the turn: labels as VoxelMemory::hit says.
  void take(const Scan& scan, EchoLabels& labels) {
    const Placement placement = window().placementOf(scan);
    see_through_.begin(placement, scan.echoes, memory_.parts());
    memory_.hit(scan, placement, labels, [&](std::size_t part, std::size_t first, const EchoBlock& block) {
      see_through_.add(part, first, block);
    });
    see_through_.finish(memory_.workers());
    memory_.seeThrough(
        [&](std::uint64_t candidates, const Index3& corner) { return see_through_.seenThrough(candidates, corner); });
  }

  void reset() {
    memory_.reset();
    see_through_.reset();
  }

  const GridWindow& window() const { return memory_.window(); }
  std::vector<std::uint32_t> noEchoes() const { return memory_.noEchoes(); }
  std::vector<Index3> newVoxels() const { return memory_.newVoxels(); }
  std::vector<Index3> remembered() const { return memory_.remembered(); }
  std::size_t memoryBytes() const { return memory_.memoryBytes() + see_through_.memoryBytes(); }

 private:
  static Config onOneThread(Config config) {
    config.threads = 1;
    return config;
  }

  VoxelMemory memory_;
  SeeThrough see_through_;
};

}  // namespace donex
