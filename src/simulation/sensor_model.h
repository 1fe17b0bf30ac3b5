// Where the rays of a sensor go: rotating sensors, solid-state ones, and ones whose pattern never repeats.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace donex::simulation {

/// The tangents of some rays' elevations, rising; they belong to somebody else.
class Slopes {
 public:
  Slopes(const std::vector<float>& all) : Slopes(all.data(), all.size()) {}  // NOLINT: a whole table is one, too
  Slopes(const float* first, std::size_t count) : first_(first), count_(count) {}

  std::size_t size() const { return count_; }
  float operator[](std::size_t i) const { return first_[i]; }

 private:
  const float* first_;
  std::size_t count_;
};

struct SensorModel {
  std::vector<float> slopes;  ///< tangents of the beams' elevations, rising; one per ring
  /// Unit vectors in the sensor's axes, one per column; the first points backwards, then clockwise seen from above.
  std::vector<Eigen::Vector2d> headings;
  float min_range = 0.9f;     ///< [m]
  bool is_even_turn = true;   ///< the columns go round evenly, as above; otherwise they are in the order of firing
  bool one_ray_each = false;  ///< each column is one ray, its tangent slopes[column]
  int lines = 0;              ///< of one_ray_each: lasers that take turns

  int beams() const { return one_ray_each ? 1 : static_cast<int>(slopes.size()); }
  int columns() const { return static_cast<int>(headings.size()); }  ///< firings a turn
  int ring(int column, int beam) const { return one_ray_each ? column % lines : beam; }
  Slopes slopesOf(int column) const {
    return one_ray_each ? Slopes(&slopes[static_cast<std::size_t>(column)], 1) : Slopes(slopes);
  }
};

/// 16 and 32: sparse sensors with even tables; 64: two blocks of beams, finer above; 128: densest around the horizon.
/// Throws std::invalid_argument for another number.
SensorModel makeSensorModel(int beams);

}  // namespace donex::simulation
