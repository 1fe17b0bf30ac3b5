// The local ground: which echoes lie on it (algorithm: "Ground").
#pragma once

#include <cstddef>
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

  /// The same of every echo of the last estimate (the same points again).
  void heightsOf(const std::vector<Eigen::Vector3f>& echoes, std::vector<float>& heights) const;

  std::size_t memoryBytes() const;
  /// What memoryBytes will be, for scans of so many echoes [bytes].
  static double bytesFor(double reach, double echoes);

 private:
  struct Cell {
    std::int16_t x, y;     ///< from the sensor's
    std::uint32_t nearer;  ///< which neighbours are nearer to the sensor, and in the map: a bit each
    int squaredDistance() const { return x * x + y * y; }
  };
  struct Neighbour {
    int x, y;
    std::ptrdiff_t offset;  ///< of its index
    float away;             ///< [m]
    float climb;            ///< how far the plane around the sensor rises to it [m]
  };

  static int widthOf(double reach);
  std::size_t indexOf(int x, int y) const {
    const int middle = width_ / 2;
    return static_cast<std::size_t>(y + middle) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x + middle);
  }
  float heightIn(int cell, float z) const;
  static Eigen::Vector2f offsetOf(const Cell& cell);  ///< from the sensor's cell [m]
  bool findStart();                                   ///< false where no echo is near
  Eigen::Vector3f fitStart(float reach) const;
  /// As Cell::nearer.
  std::uint32_t neighboursNearerTo(int x, int y) const;
  /// Height of the plane around the sensor, `offset` [m] from there.
  float startAt(const Eigen::Vector2f& offset) const { return start_.head<2>().dot(offset) + start_.z(); }
  /// What the ground of nearer cells lets expect.
  struct Continuation {
    float height;
    float unseen;  ///< how far away the ground was last seen [m]
  };
  Continuation continueTo(const Cell& cell) const;

  int width_;  ///< cells along an edge
  Eigen::Vector3f sensor_ = Eigen::Vector3f::Zero();
  std::vector<Cell> outwards_;  ///< by distance from the sensor
  std::vector<Neighbour> around_;
  std::vector<int> cell_of_;                         ///< by echo, -1 outside
  std::vector<float> lowest_, ground_;               ///< by cell [m]
  std::vector<float> unseen_;                        ///< by cell: how far the ground is only continued [m]
  std::vector<Eigen::Vector3f> near_;                ///< lowest echoes of the cells around the sensor, from there [m]
  Eigen::Vector3f start_ = Eigen::Vector3f::Zero();  ///< slopes along x, y, and the height under the sensor [m]
};

}  // namespace donex
