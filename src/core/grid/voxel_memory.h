// The 3D grid's memory: which voxels still carry an identifier (paper, 3D: shadowing, de-shadowing).
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "core/grid/brick_layout.h"
#include "core/grid/grid_window.h"
#include "core/grid/taken_echoes.h"
#include "core/grid/workers.h"

namespace donex {

/// M of the algorithm ("The paper's rule in 3D", "The paper's rule on parts"), in the window's coordinates. A turn is
/// beginTurn, then hit and seeThrough for each of its clouds; a whole scan is a turn of one cloud.
class VoxelMemory {
 public:
  explicit VoxelMemory(const Config& config);

  /// Remembers the turn before: M_{k-1} = H_{k-1} u { v in M' \ H_{k-1} : v not seen through }. Then M' =
  /// shift(M_{k-1}): moves the memory to the vehicle's new pose; what leaves the window is forgotten.
  void beginTurn(const Eigen::Isometry3d& odom_from_base);

  /// The first half of a cloud: marks what it hits of H_k and judges. `labels.dynamic` is 1 where an echo's voxel is
  /// not remembered (H_k \ M'), `labels.observed` where the echo is inside the grid. `also(part, first, block)` is
  /// shown the blocks, too; those of different parts at the same time.
  template <class Also>
  void hit(const Scan& scan, const Placement& placement, EchoLabels& labels, Also&& also);
  /// The second: what of M' \ H_k its lines of sight see through. `seen(candidates, corner)` says which of a brick's
  /// candidates are, as bits of the voxels from `corner` upwards; it is asked by several threads.
  template <class Seen>
  void seeThrough(Seen&& seen);

  void reset();

  const GridWindow& window() const { return window_; }
  const Workers& workers() const { return workers_; }
  std::size_t parts() const { return parts_.size(); }
  /// Numbers of the last cloud's invalid echoes (non-finite, too far).
  std::vector<std::uint32_t> noEchoes() const { return noEchoesOf(parts_); }
  /// Voxels of the last cloud's new echoes, in the window; a voxel may come more than once.
  std::vector<Index3> newVoxels() const { return newVoxelsOf(parts_); }
  /// What would be remembered if the turn were over, in the window; order is not specified.
  std::vector<Index3> remembered() const;
  std::size_t memoryBytes() const;
  /// What memoryBytes will be, for scans of so many echoes [bytes]. Contents that are resampled come on top.
  static double bytesFor(double slots, double echoes, int threads);

 private:
  /// Surfaces fill far fewer bricks than one in so many: room for them is there from the beginning.
  static constexpr std::size_t kSlotsAUsedBrick = 8;
  static constexpr std::size_t kBricksAhead = 12;  ///< bricks are asked of memory so long before they are needed

  struct Brick {
    std::uint64_t remembered = 0, hit = 0;  ///< a bit per voxel: M', and what the turn has hit
  };
  /// A brick that holds anything.
  struct Used {
    std::uint32_t slot;
    Index3 corner;                   ///< its lowest voxel, in the grid's frame
    std::uint64_t seen_through = 0;  ///< which of Brick::remembered the turn has seen through; it may hit them later

    std::uint64_t rememberedOf(const Brick& brick) const { return (brick.remembered & ~seen_through) | brick.hit; }
  };
  /// What a remembered voxel stands for while its contents are resampled: a point that moves with the world.
  struct Content {
    Eigen::Vector3d in_odom;  ///< [m]; kept in the odometry frame, so no error gathers over many shifts
    BrickBit at;
  };

  /// What one thread finds in its part of a cloud.
  struct Part {
    TakenEchoes echoes;
    std::vector<Index3> hit_voxels;  ///< resample: in the order of their first echoes; the first part has the turn's
    std::vector<std::uint64_t> hit;  ///< by slot, as Brick::hit; the first part uses that
    std::vector<Used> touched;       ///< bricks with hits, each once; the first part uses used_
  };

  void scroll(const Eigen::Isometry3d& odom_from_base);
  void resample(const Eigen::Isometry3d& odom_from_base);
  void hit(std::size_t part, std::size_t first, const EchoBlock& block, EchoLabels& labels);
  template <class HitOf>
  void hit(Part& part, std::size_t first, const EchoBlock& block, const BlockSlots& at, EchoLabels& labels,
           HitOf&& hit_of);
  /// Adds what a part found to what the first one did.
  void takeOver(Part& part);
  /// More stretches of used_ than threads: some are much more work than others.
  std::size_t stretches() const { return parts_.size() == 1 ? 1 : 16 * parts_.size(); }
  std::size_t beginOf(std::size_t stretch) const { return used_.size() * stretch / stretches(); }
  template <class Seen>
  void seeThroughSome(std::size_t first, std::size_t last, Seen& seen);
  void rememberTurn();
  std::size_t rememberSome(std::size_t first, std::size_t last);
  void forgetHitContents();
  void rememberContents();
  Brick& brickAt(std::uint32_t slot, const Index3& in_window);
  Used usedAt(std::uint32_t slot, const Index3& in_window) const;
  void clearBricks();

  GridWindow window_;
  BrickLayout layout_;
  std::vector<Brick> bricks_;      ///< by slot; one more for the echoes outside
  std::vector<Used> used_;         ///< each once
  std::vector<std::size_t> kept_;  ///< how many of each stretch of used_ stay
  Workers workers_;
  std::vector<Part> parts_;        ///< one per thread
  std::vector<Content> contents_;  ///< resample: one a remembered voxel
};

template <class Also>
void VoxelMemory::hit(const Scan& scan, const Placement& placement, EchoLabels& labels, Also&& also) {
  const std::size_t blocks = blocksOf(scan.echoes.size());
  labels.resize(scan.echoes.size());
  const auto hit_part = [&](std::size_t part) {
    const std::size_t first = firstBlockOf(part, parts_.size(), blocks);
    const std::size_t last = firstBlockOf(part + 1, parts_.size(), blocks);
    parts_[part].echoes.begin((last - first) * EchoBlock::kSize);
    forEachBlock(placement, scan.echoes, first, last, [&](std::size_t first_echo, const EchoBlock& block) {
      hit(part, first_echo, block, labels);
      also(part, first_echo, block);
    });
  };
  workers_.each(parts_.size(), std::ref(hit_part));  // by reference: a copy of it would be allocated
  for (std::size_t part = 1; part < parts_.size(); ++part) takeOver(parts_[part]);
}

/// Bricks `first` to `last` (not included) of used_.
template <class Seen>
void VoxelMemory::seeThroughSome(std::size_t first, std::size_t last, Seen& seen) {
  for (std::size_t i = first; i < last; ++i) {
    if (i + kBricksAhead < last) __builtin_prefetch(&bricks_[used_[i + kBricksAhead].slot]);
    Used& used = used_[i];
    const Brick& brick = bricks_[used.slot];
    const std::uint64_t candidates = brick.remembered & ~brick.hit & ~used.seen_through;
    if (candidates != 0) used.seen_through |= seen(candidates, used.corner - window_.minIndex());
  }
}

template <class Seen>
void VoxelMemory::seeThrough(Seen&& seen) {
  const auto see_some = [&](std::size_t i) { seeThroughSome(beginOf(i), beginOf(i + 1), seen); };
  workers_.each(stretches(), std::ref(see_some));
}

}  // namespace donex
