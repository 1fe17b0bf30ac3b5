// Where the grid lies: which part of the world it covers, and how echoes get their place in it.
#pragma once

#include <vector>

#include "core/grid/echo_block.h"
#include "core/grid/farthest_echo.h"
#include "core/grid/line_of_sight.h"
#include "donex/config.h"
#include "donex/grid_outline.h"
#include "donex/scan.h"

namespace donex {

/// `i` of a window that wraps around after `n`; `i` is below 2 n.
inline int wrapped(int i, int n) { return i >= n ? i - n : i; }

/// The same of any `i`.
inline int modulo(int i, int n) { return (i % n + n) % n; }

/// Distance from the vehicle to the region's farthest corner, seen from above [m].
double reachOf(const Region& region);

/// A scan in the grid: what every method works on. All of it is in the grid's window, in voxel edge lengths.
struct GridScan {
  Eigen::Vector3f origin = Eigen::Vector3f::Zero();  ///< sensor
  /// One per echo, NaN for invalid echoes (non-finite, or too far).
  std::vector<Eigen::Vector3f> echoes;
  /// One per echo: inside the region of interest and the window, the echo hits the grid. Others only see through it.
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

  /// Places the window around the vehicle at this pose.
  void moveTo(const Eigen::Isometry3d& odom_from_base);

  /// How a scan lies in the window, taken at whatever pose: parts of a turn enter the window of its first one.
  Placement placementOf(const Scan& scan) const;
  /// Gives every echo its place.
  void enter(const Scan& scan, GridScan& result) const {
    beginScan(scan, result);
    enterSome(scan, 0, scan.echoes.size(), result);
  }
  /// The same in two steps: makes room for the echoes,
  void beginScan(const Scan& scan, GridScan& result) const;
  /// and enters those from `first`, where a block begins, to `last` (not included).
  void enterSome(const Scan& scan, std::size_t first, std::size_t last, GridScan& result) const;

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
  /// The window's lowest corner, with the grid's axes: where GridScan is in, but for its scale.
  Eigen::Isometry3d odomFromWindow() const {
    return odom_from_grid_ * Eigen::Translation3d(min_index_.cast<double>() * voxel_size_);
  }
  /// Centre of a voxel of the window, grid frame [m].
  Eigen::Vector3d indexToCenter(const Index3& in_window) const {
    return ((in_window + min_index_).cast<double>().array() + 0.5) * voxel_size_;
  }

  GridOutline outline() const;

  /// Voxels along the edge of a brick: the window scrolls by whole bricks.
  static constexpr int kBrick = 4;

 private:
  Eigen::Isometry3d gridFrom(const Eigen::Isometry3d& odom_from_base) const;

  Compensation compensation_;
  double voxel_size_;
  Region region_;
  Index3 extent_, min_index_;
  Eigen::Isometry3d odom_from_grid_ = Eigen::Isometry3d::Identity();
};

/// A scan's echoes from the window's lowest corner [m], and which of them are echoes at all.
void placePoints(const GridWindow& window, const GridScan& scan, std::vector<Eigen::Vector3f>& points,
                 std::vector<std::uint8_t>& is_echo);
/// The same of those from `first` to `last` (not included), where there is room for them.
void placeSomePoints(const GridWindow& window, const GridScan& scan, std::size_t first, std::size_t last,
                     std::vector<Eigen::Vector3f>& points, std::vector<std::uint8_t>& is_echo);

/// An order of voxels.
bool isBefore(const Index3& a, const Index3& b);

/// Centres of voxels of the window, each once, odometry frame [m].
std::vector<Eigen::Vector3f> cellCenters(const GridWindow& window, std::vector<Index3> voxels);
/// Centres of the voxels that hold a marked echo, each once, odometry frame [m]. `marked`: one per echo.
std::vector<Eigen::Vector3f> cellCenters(const GridWindow& window, const GridScan& scan,
                                         const std::vector<std::uint8_t>& marked);

}  // namespace donex
