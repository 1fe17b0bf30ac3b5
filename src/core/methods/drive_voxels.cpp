#include "core/methods/drive_voxels.h"

#include <algorithm>

namespace donex {
namespace {

/// All voxels up to `reach` away along each axis but the voxel itself.
template <class Visit>
void visitAround(const Index3& voxel, int reach, Visit&& visit) {
  for (int z = -reach; z <= reach; ++z) {
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -reach; x <= reach; ++x) {
        if (x != 0 || y != 0 || z != 0) visit(Index3(voxel + Index3(x, y, z)));
      }
    }
  }
}

/// To look for neighbours any voxel of that key does: theirs have the same keys.
Index3 anyOfKey(VoxelKey key) { return voxelOfKey(key, Index3::Zero()); }

}  // namespace

bool DriveVoxel::isHitNear(std::uint32_t scan, std::uint32_t reach) const {
  const auto first = std::lower_bound(scans.begin(), scans.end(), scan > reach ? scan - reach : 0U);
  return first != scans.end() && *first <= scan + reach;
}

void DriveVoxels::add(const Index3& voxel, std::uint32_t scan) {
  const VoxelKey key = keyOf(voxel);
  const auto [found, is_new] = voxels_.try_emplace(key);
  if (is_new) blocks_[keyOf(blockOf(voxel))].push_back(key);
  std::vector<std::uint32_t>& scans = found->second.scans;
  if (scans.empty() || scans.back() != scan) scans.push_back(scan);
}

const DriveVoxel* DriveVoxels::find(const Index3& voxel) const {
  const auto found = voxels_.find(keyOf(voxel));
  return found == voxels_.end() ? nullptr : &found->second;
}

std::vector<VoxelKey> DriveVoxels::clusterAround(VoxelKey start,
                                                 std::unordered_map<VoxelKey, bool, VoxelHash>& seen) const {
  std::vector<VoxelKey> cluster{start};
  seen[start] = true;
  for (std::size_t next = 0; next < cluster.size(); ++next) {
    visitAround(anyOfKey(cluster[next]), 1, [&](const Index3& neighbour) {
      const DriveVoxel* voxel = find(neighbour);
      const bool joins = voxel != nullptr && voxel->free && seen.try_emplace(keyOf(neighbour), true).second;
      if (joins) cluster.push_back(keyOf(neighbour));
    });
  }
  return cluster;
}

void DriveVoxels::dropSmallClusters(std::size_t least) {
  std::unordered_map<VoxelKey, bool, VoxelHash> seen;
  std::vector<VoxelKey> dropped;
  for (const auto& [key, voxel] : voxels_) {
    if (!voxel.free || seen.count(key) != 0) continue;
    const auto cluster = clusterAround(key, seen);
    if (cluster.size() < least) dropped.insert(dropped.end(), cluster.begin(), cluster.end());
  }
  for (const VoxelKey key : dropped) voxels_.at(key).free = false;
}

void DriveVoxels::markHalfFreed() {
  constexpr int kReach = 2;
  for (const auto& [key, voxel] : voxels_) {
    if (!voxel.free) continue;
    visitAround(anyOfKey(key), kReach, [&, &scans = voxel.scans](const Index3& neighbour) {
      DriveVoxel* near_voxel = find(neighbour);
      if (near_voxel == nullptr || near_voxel->free) return;
      near_voxel->half_freed.insert(near_voxel->half_freed.end(), scans.begin(), scans.end());
    });
  }
  for (auto& entry : voxels_) {
    std::vector<std::uint32_t>& scans = entry.second.half_freed;
    std::sort(scans.begin(), scans.end());
    scans.erase(std::unique(scans.begin(), scans.end()), scans.end());
    scans.shrink_to_fit();
  }
}

std::size_t DriveVoxels::memoryBytes() const {
  constexpr std::size_t kNode = sizeof(VoxelKey) + sizeof(DriveVoxel) + 3 * sizeof(void*) + sizeof(VoxelKey);
  std::size_t bytes = voxels_.size() * kNode;
  for (const auto& [key, voxel] : voxels_) {
    bytes += (voxel.scans.capacity() + voxel.half_freed.capacity()) * sizeof(std::uint32_t);
  }
  return bytes;
}

}  // namespace donex
