// When each voxel became occupied, and whether it had been free before (algorithm: "Birth age").
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/evidence/judged_scan.h"
#include "core/grid/brick_layout.h"
#include "core/grid/grid_window.h"

namespace donex {

/// What is remembered of a voxel.
struct VoxelRecord {
  std::uint32_t birth = 0;           ///< scan in which it became occupied; 0: it never was
  std::uint32_t last_hit = 0;        ///< scan that hit it last
  bool was_free = false;             ///< at its birth the place had been seen free
  Place place = Place::kUnobserved;  ///< what it was at its birth

  bool occupied() const { return birth != 0; }
};

/// Records of the voxels that were ever hit while they were in the window. Bricks of 4 x 4 x 4 records
/// are held only where something was hit: memory is bounded by the region, not by the distance driven.
class BirthMemory {
 public:
  /// `config.compensation` must be `scroll` (std::invalid_argument).
  explicit BirthMemory(const Config& config);

  /// Moves the memory to the vehicle's new pose; what leaves the window is forgotten.
  void shift(const Eigen::Isometry3d& odom_from_base);

  /// Record of a voxel in the window, or nullptr where nothing is remembered.
  const VoxelRecord* find(const Index3& in_window) const;
  /// Record of a voxel in the window, made where it is missing. Valid until the next call.
  VoxelRecord& at(const Index3& in_window);

  /// Calls visit(voxel in the window, record) for every voxel that is remembered.
  template <class Visit>
  void forEach(Visit&& visit) const {
    for (const Brick& brick : bricks_) {
      const Index3 corner = layout_.cornerOf(brick.slot);
      for (int bit = 0; bit < 64; ++bit) {
        const VoxelRecord& record = brick.records[static_cast<std::size_t>(bit)];
        if (record.occupied()) visit(BrickLayout::voxelOfBit(corner, bit), record);
      }
    }
  }

  /// Asks memory for a record that will be wanted soon.
  void expect(const Index3& in_window) const {
    const BrickBit at = layout_.locate(in_window);
    const std::uint32_t brick = brick_of_slot_[at.slot];
    if (brick != kNoBrick) __builtin_prefetch(&bricks_[brick].records[at.bit], 1);
  }

  void reset();
  const GridWindow& window() const { return window_; }
  std::size_t memoryBytes() const;
  /// What memoryBytes will be for a window of so many voxels, as long as surfaces fill no more bricks than the ground
  /// plan has [bytes].
  static double bytesFor(const Eigen::Vector3d& extent);

 private:
  struct Brick {
    std::uint32_t slot;
    std::array<VoxelRecord, 64> records;
  };
  static constexpr std::uint32_t kNoBrick = 0xFFFFFFFF;

  void forget(std::uint32_t brick);

  GridWindow window_;
  BrickLayout layout_;
  std::vector<std::uint32_t> brick_of_slot_;
  std::vector<Brick> bricks_;
};

}  // namespace donex
