// The voxels between sensor and echo: Amanatides & Woo, "A fast voxel traversal algorithm" (1987).
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <Eigen/Core>

namespace donex {

/// Index of a voxel: it holds the points u with floor(u) == index, u in voxel edge lengths.
using Index3 = Eigen::Vector3i;

/// floor, as an integer; without SSE 4.1 std::floor is a call. |x| below 2^31.
inline int floorToInt(float x) {
  const int truncated = static_cast<int>(x);
  return truncated - (static_cast<float>(truncated) > x ? 1 : 0);
}

inline Index3 voxelOf(const Eigen::Vector3f& u) { return {floorToInt(u.x()), floorToInt(u.y()), floorToInt(u.z())}; }

/// A line of sight from the sensor's origin to an echo, both in voxel edge lengths and finite,
/// coordinates below 2^30. As a range it yields the voxels from the origin's to the last one
/// before the echo's own: those that the echo proves to be free (paper, "De-Shadowing").
///
/// The traversal is a merge of the three axes' face crossings, sorted by (parameter, axis). Each
/// crossing's parameter is computed by itself and not by repeated addition: it carries no
/// accumulated error, the end voxel is always met exactly, and whether one given voxel lies on the
/// line can be answered alone (`crosses`) with the very same result.
class LineOfSight {
 public:
  LineOfSight(const Eigen::Vector3f& origin, const Eigen::Vector3f& echo)
      : origin_(origin), start_(voxelOf(origin)), end_(voxelOf(echo)) {
    for (int axis = 0; axis < 3; ++axis) {
      step_[axis] = end_[axis] >= start_[axis] ? 1 : -1;
      inverse_[axis] = 1.0 / (static_cast<double>(echo[axis]) - static_cast<double>(origin[axis]));
    }
  }

  const Index3& originVoxel() const { return start_; }
  const Index3& echoVoxel() const { return end_; }

  /// True where the range holds `voxel`.
  bool crosses(const Index3& voxel) const {
    double entered = -std::numeric_limits<double>::infinity();
    double left = std::numeric_limits<double>::infinity();
    int entered_axis = -1, left_axis = 3;
    for (int axis = 0; axis < 3; ++axis) {
      const int done = (voxel[axis] - start_[axis]) * step_[axis];
      const int to_do = (end_[axis] - voxel[axis]) * step_[axis];
      if (done < 0 || to_do < 0) return false;
      // >= and <: crossings at the same parameter happen in the order of the axes.
      if (done > 0) {
        const double t = entryOf(axis, voxel[axis]);
        if (t >= entered) entered = t, entered_axis = axis;
      }
      if (to_do > 0) {
        const double t = entryOf(axis, voxel[axis] + step_[axis]);
        if (t < left) left = t, left_axis = axis;
      }
    }
    const bool is_end = left_axis == 3;
    return !is_end && (entered < left || (entered == left && entered_axis < left_axis));
  }

  class Iterator {
   public:
    Iterator(const LineOfSight& line, int steps_left) : line_(line), steps_left_(steps_left), voxel_(line.start_) {
      for (int axis = 0; axis < 3; ++axis) next_[axis] = nextCrossing(axis);
    }
    const Index3& operator*() const { return voxel_; }
    Iterator& operator++() {
      int axis = next_[1] < next_[0] ? 1 : 0;
      if (next_[2] < next_[axis]) axis = 2;
      voxel_[axis] += line_.step_[axis];
      next_[axis] = nextCrossing(axis);
      --steps_left_;
      return *this;
    }
    bool operator!=(const Iterator& other) const { return steps_left_ != other.steps_left_; }

   private:
    double nextCrossing(int axis) const {
      if (voxel_[axis] == line_.end_[axis]) return std::numeric_limits<double>::infinity();
      return line_.entryOf(axis, voxel_[axis] + line_.step_[axis]);
    }

    const LineOfSight& line_;
    int steps_left_;
    Index3 voxel_;
    std::array<double, 3> next_;
  };

  Iterator begin() const { return {*this, (end_ - start_).cwiseAbs().sum()}; }
  Iterator end() const { return {*this, 0}; }

 private:
  /// Parameter (0 origin, 1 echo) at which the line enters index `i` of `axis` from its neighbour.
  double entryOf(int axis, int i) const {
    const int face = step_[axis] > 0 ? i : i + 1;
    return (face - static_cast<double>(origin_[axis])) * inverse_[axis];
  }

  Eigen::Vector3f origin_;
  Index3 start_, end_, step_;
  std::array<double, 3> inverse_;
};

}  // namespace donex
