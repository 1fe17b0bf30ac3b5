// A map of static echoes: one point per voxel, in bounded memory, as a PCD file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <unordered_map>
#include <utility>

#include <Eigen/Core>

#include "core/grid/voxel_key.h"
#include "io/data_error.h"

namespace donex {

/// Voxels keep the mean of their points. They are held by square tiles of the ground plan; where they need more than
/// `memory_limit`, tiles far from the vehicle are put away into files beside the output, and read back when the
/// map is written. What remains in memory at any time: that limit and one tile.
class StaticMap {
 public:
  /// `file` is the PCD to be written; its directory must exist. `memory_limit` [bytes].
  StaticMap(std::filesystem::path file, double voxel_size, std::size_t memory_limit);

  /// Removes what was put away.
  ~StaticMap();
  StaticMap(const StaticMap&) = delete;
  StaticMap& operator=(const StaticMap&) = delete;

  /// A point of the odometry frame [m], at most 200 km from the first one at 0.2 m voxels.
  void add(const Eigen::Vector3d& in_odom);

  /// Keeps to the limit; call once per scan. Throws DataError where a file cannot be written.
  void settle(const Eigen::Vector3d& vehicle);

  /// Writes x, y, z from origin() as binary float32, whole or not at all; the map is empty then. Returns how many
  /// points. Throws DataError.
  std::size_t write();

  /// Where in the odometry frame the map's coordinates begin [m]: at its origin, or, where the first point is more than
  /// 10 km from that (UTM), at whole kilometres near it; float32 would not tell such points apart.
  Eigen::Vector3d origin() const { return origin_.value_or(Eigen::Vector3d::Zero()); }

  std::size_t memoryBytes() const { return voxels_ * kBytesAVoxel; }
  std::size_t tilesPutAway() const { return put_away_.size(); }

  static constexpr double kTile = 32.0;  ///< edge of a tile [m]

 private:
  struct Mean {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();  ///< of the points, relative to their voxel's corner [m]
    std::uint32_t count = 0;
  };
  using Tile = std::unordered_map<VoxelKey, Mean, VoxelHash>;
  using TileIndex = std::pair<int, int>;

  /// Key, mean, the map's own pointers and their share of buckets.
  static constexpr std::size_t kBytesAVoxel = sizeof(VoxelKey) + sizeof(Mean) + 4 * sizeof(void*);

  std::filesystem::path fileOf(const TileIndex& index) const;
  void putAway(const TileIndex& index);
  void takeBack(const TileIndex& index, Tile& tile) const;
  std::size_t writeTile(const TileIndex& index, const Tile& tile, std::ostream& stream) const;
  void removePutAway();

  std::filesystem::path file_;
  double voxel_size_;
  std::optional<Eigen::Vector3d> origin_;  ///< once there is a point
  std::size_t memory_limit_;
  std::size_t voxels_ = 0;  ///< in memory
  std::map<TileIndex, Tile> tiles_;
  std::map<TileIndex, std::size_t> put_away_;  ///< how many voxels
};

}  // namespace donex
