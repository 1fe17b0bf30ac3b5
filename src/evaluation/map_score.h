// How well a map keeps static echoes and leaves out moving ones.
#pragma once

#include <cstdint>
#include <unordered_map>

#include <Eigen/Core>

#include "core/grid/voxel_key.h"

namespace donex {

/// By voxel, as ERASOR does (Lim, Hwang & Myung, RA-L 2021, section IV): of the voxels that a map of all echoes has,
/// those with more static than moving echoes are static, the others dynamic. A static voxel is preserved when the map
/// keeps a static echo in it; a dynamic voxel is rejected when the map keeps none of its moving echoes.
/// By echo, as DynamicMap_Benchmark does (Zhang et al., ITSC 2023): SA and DA are the shares of static echoes that are
/// kept and of moving ones that are left out; AA is their geometric mean.
class MapScore {
 public:
  explicit MapScore(double voxel_size = 0.2) : voxel_size_(voxel_size) {}

  /// An echo of known truth, odometry frame [m].
  void add(const Eigen::Vector3d& point, bool is_moving, bool is_kept);

  struct Rates {
    double preservation = 0.0, rejection = 0.0, f1 = 0.0;                    ///< PR, RR; NaN where undefined
    double static_accuracy = 0.0, dynamic_accuracy = 0.0, associated = 0.0;  ///< SA, DA, AA
    std::uint64_t static_voxels = 0, dynamic_voxels = 0;
    std::uint64_t static_echoes = 0, dynamic_echoes = 0;
  };
  Rates rates() const;

 private:
  struct Voxel {
    std::uint32_t fixed = 0, moving = 0, kept_fixed = 0, kept_moving = 0;
  };

  double voxel_size_;
  std::unordered_map<VoxelKey, Voxel, VoxelHash> voxels_;
};

}  // namespace donex
