// The lines of sight of one scan by direction: which of them can cross a given box?
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid/echo_block.h"
#include "core/grid/line_of_sight.h"
#include "core/grid/workers.h"

namespace donex {

/// Sorts the echoes of a scan into bins of direction. Directions are projected on a square prism
/// around the sensor (a unit square in x, y): a bin is a strip of one of its four sides times a
/// strip of height. No angle is ever computed, and the projection of a box is bounded by that of
/// its corners, so a box finds all lines of sight that can cross it, and few others.
///
/// Most questions are decided in the projection, in single precision with a margin for its rounding; the few within
/// the margin are put to LineOfSight. So every answer is that of the traversal.
class RayIndex {
 public:
  static constexpr bool kParallel = true;

  /// Begins a scan: where it lies, and its echoes in the sensor's frame, which must stay until the last question. Its
  /// blocks come in so many parts (firstBlockOf).
  void begin(const Placement& placement, const std::vector<Eigen::Vector3f>& echoes, std::size_t parts);
  /// Takes a block of a part; its first echo is number `first` of the scan. Blocks of different parts may be taken at
  /// the same time.
  void add(std::size_t part, std::size_t first, const EchoBlock& block);
  /// All blocks are there: sorts. Questions may be asked from now on, also at the same time.
  void finish(const Workers& workers);

  /// Those of `candidates` (bits of the 4 x 4 x 4 voxels from `corner` upwards, as BrickLayout numbers them) that some
  /// line of sight crosses before its own echo's voxel.
  std::uint64_t seenThrough(std::uint64_t candidates, const Index3& corner) const;

  /// Makes the next scan's bins as if no scan had been before.
  void reset() { next_rows_ = Rows{}; }

  std::size_t memoryBytes() const;
  /// What memoryBytes will be, for scans of so many echoes [bytes].
  static double bytesFor(double echoes, int parts);

 private:
  static constexpr int kSides = 4;

  /// Lines of sight on their sides of the prism, coordinate by coordinate.
  struct Rays {
    std::vector<float> across, up;  ///< direction: tangents
    std::vector<float> depth;       ///< of the echo, along the side's axis [voxels]

    void resize(std::size_t rays);
  };
  struct Bin {
    std::uint32_t first;  ///< where its rays begin in rays_
    float farthest;       ///< largest depth [voxels]; negative where it has no ray
  };
  static constexpr Bin kEmpty = {0, -1.0F};
  /// Heights are binned over what the scan before covered: sensors look up and down differently far.
  struct Rows {
    float low = -1.0F, per_up = 64.0F;
  };
  /// A box as the sensor sees it on one side of the prism.
  struct Shadow;
  /// A brick that lies on one side of the prism alone, well ahead of the sensor.
  struct BrickAhead;
  enum class Crossing { kNo, kYes, kUnsure };

  bool shadowOn(int side, const Eigen::Vector3f& low, const Eigen::Vector3f& high, Shadow& shadow) const;
  void findBins(Shadow& shadow) const;
  static Shadow shadowOf(const BrickAhead& brick, const Index3& low, int edge);
  bool anyRayReaches(const Shadow& shadow) const;
  bool anyRayCrosses(const Shadow& shadow, const Index3& voxel) const;
  bool seesThrough(const Index3& voxel) const;
  bool maySeeThrough(const Index3& corner, int edge) const;
  std::uint64_t seenThrough(std::uint64_t candidates, const BrickAhead& brick, const Index3& corner) const;
  Crossing judge(std::uint32_t ray, const Shadow& box) const;
  bool crosses(std::uint32_t ray, const Index3& voxel) const;
  /// The bins of a strip of a side, from the lowest row upwards.
  const Bin* stripOf(int side, int column) const;
  int rowOf(float up) const;
  void sortPart(std::size_t part);
  Rows rowsOfScan() const;

  Placement placement_;
  const std::vector<Eigen::Vector3f>* echoes_ = nullptr;
  Rows rows_, next_rows_;
  Rays by_echo_;
  std::vector<std::uint32_t> bin_of_echo_;
  /// By part. While a part is taken, `first` counts its rays; in the end the first part's bins are those of the scan.
  std::vector<std::vector<Bin>> bins_of_part_;
  Rays rays_;  ///< by bin
  std::vector<std::uint32_t> echo_of_ray_;
};

}  // namespace donex
