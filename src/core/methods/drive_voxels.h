// The voxels that a whole drive has hit, and in which of its scans.
#pragma once

#include <unordered_map>
#include <utility>
#include <vector>

#include "core/grid/voxel_key.h"

namespace donex {

struct DriveVoxel {
  std::vector<std::uint32_t> scans;       ///< that hit it, rising
  std::vector<std::uint32_t> half_freed;  ///< scans that also hit a free voxel nearby, rising
  bool free = false;                      ///< a line of sight of another scan saw through it

  /// True where a scan at most `reach` before or after `scan` hit it.
  bool isHitNear(std::uint32_t scan, std::uint32_t reach) const;
};

/// Unbounded: as large as what the drive has seen.
class DriveVoxels {
 public:
  /// Scans come in rising order.
  void add(const Index3& voxel, std::uint32_t scan);

  /// Nothing where no scan has hit it.
  const DriveVoxel* find(const Index3& voxel) const;
  DriveVoxel* find(const Index3& voxel) { return const_cast<DriveVoxel*>(std::as_const(*this).find(voxel)); }

  std::size_t size() const { return voxels_.size(); }

  /// Shows `visit(index, voxel)` every voxel with low <= index < high.
  template <class Visit>
  void visitBox(const Index3& low, const Index3& high, Visit&& visit) const {
    const Index3 first = blockOf(low), last = blockOf(high - Index3::Ones());
    for (int z = first.z(); z <= last.z(); ++z) {
      for (int y = first.y(); y <= last.y(); ++y) {
        for (int x = first.x(); x <= last.x(); ++x) visitBlock(Index3(x, y, z), low, high, visit);
      }
    }
  }

  /// Free voxels that touch (by face, edge or corner) belong together; fewer than `least` of them are free no more.
  void dropSmallClusters(std::size_t least);

  /// Passes the scans of every free voxel on to the voxels up to two away that are not free.
  void markHalfFreed();

  std::size_t memoryBytes() const;

 private:
  static constexpr int kBlockBits = 4;
  static Index3 blockOf(const Index3& voxel) {
    return {voxel.x() >> kBlockBits, voxel.y() >> kBlockBits, voxel.z() >> kBlockBits};
  }

  template <class Visit>
  void visitBlock(const Index3& block, const Index3& low, const Index3& high, Visit& visit) const {
    const auto found = blocks_.find(keyOf(block));
    if (found == blocks_.end()) return;
    for (const VoxelKey key : found->second) {
      const Index3 voxel = voxelOfKey(key, low);
      const bool is_inside = (voxel.array() >= low.array()).all() && (voxel.array() < high.array()).all();
      if (is_inside) visit(voxel, voxels_.at(key));
    }
  }

  std::vector<VoxelKey> clusterAround(VoxelKey start, std::unordered_map<VoxelKey, bool, VoxelHash>& seen) const;

  std::unordered_map<VoxelKey, DriveVoxel, VoxelHash> voxels_;
  std::unordered_map<VoxelKey, std::vector<VoxelKey>, VoxelHash> blocks_;
};

}  // namespace donex
