// Where the grid lies: which part of the world it covers, and how echoes get their place in it.
#pragma once

#include <vector>

#include "donex/core/config.h"
#include "donex/core/detector.h"
#include "donex/core/echo_block.h"
#include "donex/core/line_of_sight.h"
#include "donex/core/scan.h"

namespace donex {

/// Echoes beyond this distance from the sensor [m] are no echoes: they are treated as non-finite ones.
constexpr float kFarthestEcho = 1000.0F;

/// A scan in the grid: what every method works on. All of it is in the grid's window, in voxel edge lengths.
struct GridScan {
  Eigen::Vector3f origin = Eigen::Vector3f::Zero();  ///< sensor
  /// One an echo, NaN where the echo is none (non-finite, or too far).
  std::vector<Eigen::Vector3f> echoes;
  /// One an echo: inside the region of interest and the window, the echo hits the grid. Others only see through it.
  std::vector<std::uint8_t> inside;
};

/// The grid's window: `extent` voxels whose lowest one has index `min_index` in the grid's frame.
/// `scroll`: the frame has the odometry frame's axes and the window follows the vehicle by whole bricks.
/// `resample`: the frame is the vehicle's and the window never moves.
class GridWindow {
 public:
  explicit GridWindow(const Config& config);

  /// Voxels that the window of a configuration has along each axis, multiples of kBrick; as floating-point
  /// numbers, so that any configuration can be asked.
  static Eigen::Vector3d extentOf(const Config& config);

  /// Places the window for a scan taken at this vehicle pose.
  void moveTo(const Eigen::Isometry3d& odom_from_base);

  /// How a scan lies in the window. Call after moveTo with the scan's own pose.
  Placement placementOf(const Scan& scan) const;
  /// Gives every echo its place. Call after moveTo with the scan's own pose.
  void enter(const Scan& scan, GridScan& result) const;

  Compensation compensation() const { return compensation_; }
  double voxelSize() const { return voxel_size_; }
  /// Voxels along each axis, multiples of kBrick.
  const Index3& extent() const { return extent_; }
  /// Index of the window's lowest voxel in the grid's frame, multiples of kBrick.
  const Index3& minIndex() const { return min_index_; }
  bool contains(const Index3& in_window) const {
    return (in_window.array() >= 0).all() && (in_window.array() < extent_.array()).all();
  }

  /// Frame of the grid at the last moveTo.
  const Eigen::Isometry3d& odomFromGrid() const { return odom_from_grid_; }
  /// Centre of a voxel of the window, grid frame [m].
  Eigen::Vector3d indexToCenter(const Index3& in_window) const {
    return ((in_window + min_index_).cast<double>().array() + 0.5) * voxel_size_;
  }

  GridOutline outline() const;

  /// Voxels along the edge of a brick: the window scrolls by whole bricks.
  static constexpr int kBrick = 4;

 private:
  Compensation compensation_;
  double voxel_size_;
  Region region_;
  Index3 extent_, min_index_;
  Eigen::Isometry3d odom_from_grid_ = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d grid_from_base_ = Eigen::Isometry3d::Identity();
};

/// Centres of voxels of the window, each once, odometry frame [m].
std::vector<Eigen::Vector3f> cellCenters(const GridWindow& window, std::vector<Index3> voxels);
/// Centres of the voxels that hold a marked echo, each once, odometry frame [m]. `marked`: one an echo.
std::vector<Eigen::Vector3f> cellCenters(const GridWindow& window, const GridScan& scan,
                                         const std::vector<std::uint8_t>& marked);

}  // namespace donex
