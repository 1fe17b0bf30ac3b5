// The ground around the sensor, sampled, and where the rays of one firing meet it.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "simulation/ground.h"
#include "simulation/sensor_model.h"

namespace donex::simulation {

/// The rays of one firing: all begin at `origin` and lie in one plane; ray i has the direction forward + slopes[i] *
/// up.
struct RayFan {
  Eigen::Vector3d origin;   ///< scene frame [m]
  Eigen::Vector3d forward;  ///< unit, roughly level
  Eigen::Vector3d up;       ///< unit, roughly upright
  Slopes slopes;            ///< rising
};

/// Between the samples the height is bilinear; this is the ground that the rays see.
class GroundWindow {
 public:
  static constexpr int kCells = 1024;     ///< along an edge, a power of two
  static constexpr double kCell = 0.2;    ///< [m]
  static constexpr double kReach = 95.0;  ///< rays are followed this far from the centre, level [m]

  /// `ground` must outlive the window.
  explicit GroundWindow(const Ground& ground);

  /// Samples what is new around `center`. Call before asking.
  void moveTo(const Eigen::Vector2d& center);

  float height(double x, double y) const;
  std::uint32_t label(double x, double y) const;
  Eigen::Vector3f normal(double x, double y) const;

  /// For each ray the parameter where it enters the ground (level distance along `forward`), kMiss without.
  void meet(const RayFan& fan, std::vector<float>& parameters) const;

 private:
  static std::size_t slot(int column, int row) {
    constexpr int kMask = kCells - 1;
    return static_cast<std::size_t>(row & kMask) * kCells + static_cast<std::size_t>(column & kMask);
  }
  float heightAtCell(float u, float v) const;  // counted from the window's corner
  float enter(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float from) const;
  void sampleBlock(int first_column, int first_row, int columns, int rows);

  const Ground& ground_;
  std::vector<float> heights_;
  std::vector<std::uint8_t> labels_;
  int first_column_ = 0;
  int first_row_ = 0;
  bool filled_ = false;
};

}  // namespace donex::simulation
