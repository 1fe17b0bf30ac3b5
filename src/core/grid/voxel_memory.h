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

/// M of the algorithm ("The paper's rule in 3D"), in the window's coordinates. A scan is shift, hit, remember.
class VoxelMemory {
 public:
  explicit VoxelMemory(const Config& config);

  /// M' = shift(M_{k-1}): moves the memory to the vehicle's new pose; what leaves the window is forgotten.
  void shift(const Eigen::Isometry3d& odom_from_base);

  /// The first half of a scan: marks H_k and judges. `labels.dynamic` is 1 where an echo's voxel is hit and not
  /// remembered (H_k \ M'), `labels.observed` where the echo is inside the grid. `also(part, first, block)` is shown
  /// the blocks, too; those of different parts at the same time.
  template <class Also>
  void hit(const Scan& scan, const Placement& placement, EchoLabels& labels, Also&& also);
  /// The second: M_k = H_k u { v in M' \ H_k : v not seen through }. `seen(candidates, corner)` says which of a brick's
  /// candidates are, as bits of the voxels from `corner` upwards; it is asked by several threads.
  template <class Seen>
  void remember(Seen&& seen);

  void reset();

  const GridWindow& window() const { return window_; }
  const Workers& workers() const { return workers_; }
  std::size_t parts() const { return parts_.size(); }
  /// Numbers of the last scan's invalid echoes (non-finite, too far).
  std::vector<std::uint32_t> noEchoes() const { return noEchoesOf(parts_); }
  /// Voxels of the last scan's new echoes, in the window; a voxel may come more than once.
  std::vector<Index3> newVoxels() const { return newVoxelsOf(parts_); }
  /// Remembered voxels, in the window; order is not specified.
  std::vector<Index3> remembered() const;
  std::size_t memoryBytes() const;
  /// What memoryBytes will be, for scans of so many echoes [bytes]. Contents that are resampled come on top.
  static double bytesFor(double slots, double echoes, int threads);

 private:
  /// Surfaces fill far fewer bricks than one in so many: room for them is there from the beginning.
  static constexpr std::size_t kSlotsAUsedBrick = 8;

  struct Brick {
    std::uint64_t remembered = 0, hit = 0;  ///< a bit per voxel
  };
  /// A brick that holds anything.
  struct Used {
    std::uint32_t slot;
    Index3 corner;  ///< its lowest voxel, in the grid's frame
  };
  /// What a remembered voxel stands for while its contents are resampled: a point that moves with the world.
  struct Content {
    Eigen::Vector3d in_odom;  ///< [m]; kept in the odometry frame, so no error gathers over many shifts
    BrickBit at;
  };

  /// What one thread finds in its part of a scan.
  struct Part {
    TakenEchoes echoes;
    std::vector<Index3> hit_voxels;  ///< resample: in the order of their first echoes
    std::vector<std::uint64_t> hit;  ///< by slot, as Brick::hit; the first part uses that
    std::vector<Used> touched;       ///< bricks with hits, each once; the first part uses used_

    void begin(std::size_t most_echoes);
  };

  void scroll(const Eigen::Isometry3d& odom_from_base);
  void resample(const Eigen::Isometry3d& odom_from_base);
  void hit(std::size_t part, std::size_t first, const EchoBlock& block, EchoLabels& labels);
  template <class HitOf>
  void hit(Part& part, std::size_t first, const EchoBlock& block, const BlockSlots& at, EchoLabels& labels,
           HitOf&& hit_of);
  /// Adds what a part found to what the first one did.
  void takeOver(Part& part);
  template <class Seen>
  std::size_t rememberSome(std::size_t first, std::size_t last, Seen& seen);
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
    parts_[part].begin((last - first) * EchoBlock::kSize);
    forEachBlock(placement, scan.echoes, first, last, [&](std::size_t first_echo, const EchoBlock& block) {
      hit(part, first_echo, block, labels);
      also(part, first_echo, block);
    });
  };
  workers_.each(parts_.size(), std::ref(hit_part));  // by reference: a copy of it would be allocated
  for (std::size_t part = 1; part < parts_.size(); ++part) takeOver(parts_[part]);
}

/// Bricks `first` to `last` (not included) of used_; those that stay come first then, and are counted.
template <class Seen>
std::size_t VoxelMemory::rememberSome(std::size_t first, std::size_t last, Seen& seen) {
  constexpr std::size_t kBricksAhead = 12;  // bricks are asked of memory so long before they are needed
  std::size_t kept = first;
  for (std::size_t i = first; i < last; ++i) {
    if (i + kBricksAhead < last) __builtin_prefetch(&bricks_[used_[i + kBricksAhead].slot], 1);
    const Used& used = used_[i];
    Brick& brick = bricks_[used.slot];
    const std::uint64_t candidates = brick.remembered & ~brick.hit;
    const std::uint64_t forgotten = candidates == 0 ? 0 : seen(candidates, used.corner - window_.minIndex());
    brick.remembered = (brick.remembered & ~forgotten) | brick.hit;
    brick.hit = 0;
    if (brick.remembered != 0) used_[kept++] = used;
  }
  return kept - first;
}

template <class Seen>
void VoxelMemory::remember(Seen&& seen) {
  forgetHitContents();
  // More stretches than threads: some are much more work than others.
  const std::size_t stretches = parts_.size() == 1 ? 1 : 16 * parts_.size();
  const auto begin_of = [stretches, all = used_.size()](std::size_t i) { return all * i / stretches; };
  kept_.resize(stretches);
  const auto remember_some = [&](std::size_t i) { kept_[i] = rememberSome(begin_of(i), begin_of(i + 1), seen); };
  workers_.each(stretches, std::ref(remember_some));
  auto end = used_.begin();
  for (std::size_t i = 0; i < stretches; ++i) {
    const auto first = used_.begin() + static_cast<std::ptrdiff_t>(begin_of(i));
    end = std::move(first, first + static_cast<std::ptrdiff_t>(kept_[i]), end);
  }
  used_.erase(end, used_.end());
  rememberContents();
}

}  // namespace donex
