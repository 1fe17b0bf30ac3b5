// The lines of sight of one scan by direction: which of them can cross a given box?
#pragma once

#include <cstdint>
#include <vector>

#include "donex/core/line_of_sight.h"

namespace donex {

/// Sorts the echoes of a scan into bins of direction. Directions are projected on a square prism
/// around the sensor (a unit square in x, y): a bin is a strip of one of its four sides times a
/// strip of height. No angle is ever computed, and the projection of a box is bounded by that of
/// its corners, so a box finds all lines of sight that can cross it, and few others.
class RayIndex {
 public:
  /// Takes the echoes of a scan, window coordinates [voxels]; non-finite ones have no line of sight.
  void build(const Eigen::Vector3f& origin, const std::vector<Eigen::Vector3f>& echoes);

  /// True where some line of sight crosses `voxel` before its own echo's voxel.
  bool seesThrough(const Index3& voxel) const;

  /// False only where no line of sight crosses any voxel of the cube with lowest voxel `corner`.
  bool maySeeThrough(const Index3& corner, int edge) const;

  std::size_t memoryBytes() const {
    return (first_.capacity() + bin_of_echo_.capacity()) * sizeof(std::uint32_t) +
           rays_.capacity() * sizeof(Eigen::Vector3f) + farthest_.capacity() * sizeof(float);
  }

 private:
  static constexpr int kSides = 4;

  template <class Visit>
  bool anyBin(const Eigen::Vector3f& low, const Eigen::Vector3f& high, Visit&& visit) const;
  int binOf(const Eigen::Vector3f& direction) const;

  Eigen::Vector3f origin_ = Eigen::Vector3f::Zero();
  std::vector<std::uint32_t> first_;     ///< bins + 1: where each bin's rays start in rays_
  std::vector<Eigen::Vector3f> rays_;    ///< echoes, by bin
  std::vector<float> farthest_;          ///< bins: largest distance along the side's axis [voxels]
  std::vector<std::uint32_t> bin_of_echo_;
};

}  // namespace donex
