// The local ground: which echoes lie on it (algorithm section 5, step 5).
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace donex {

/// A height map of one scan. Cells take their lowest echo where it continues the ground of the cells
/// nearer to the sensor, and their neighbours' height where it does not: then the cell holds an object only.
class Ground {
 public:
  /// A square of `reach` [m] around the sensor.
  explicit Ground(double reach);

  /// `echoes` [m] in a frame whose z points up; those with `is_echo` 0 are left out.
  void estimate(const Eigen::Vector3f& sensor, const std::vector<Eigen::Vector3f>& echoes,
                const std::vector<std::uint8_t>& is_echo);

  /// Height above the ground [m]; infinite outside the map, or where no ground was found at all.
  float heightOf(const Eigen::Vector3f& point) const;

  std::size_t memoryBytes() const;

 private:
  int cellOf(const Eigen::Vector3f& point) const;
  float startingHeight();
  /// What the ground of nearer cells lets expect.
  struct Continuation {
    float height;
    float unseen;  ///< how far away the ground was last seen [m]
  };
  Continuation continueTo(int cell, float start) const;

  int width_;                            ///< cells along an edge
  Eigen::Vector3f sensor_ = Eigen::Vector3f::Zero();
  std::vector<int> outwards_;            ///< cells by distance from the sensor
  std::vector<float> lowest_, ground_;   ///< by cell [m]
  std::vector<float> unseen_;            ///< by cell: how far the ground is only continued [m]
  std::vector<float> near_;
};

}  // namespace donex
