#include "core/grid/grid_window.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/grid/simd.h"
#include "core/grid/storage.h"

namespace donex {
namespace {

/// The vehicle may lean this far before echoes at the region's far end leave a scrolling grid [sin].
constexpr double kLargestVehicleTilt = 0.17;  // 10 degrees

int floorToBrick(double voxels) {
  return GridWindow::kBrick * static_cast<int>(std::floor(voxels / GridWindow::kBrick));
}

/// The region, as a box around the vehicle in which it stays however the vehicle turns [m].
Region sweptRegion(const Region& r) {
  const double reach = reachOf(r);
  const double rise = kLargestVehicleTilt * reach;
  return {-reach, reach, -reach, reach, r.z_min - rise, r.z_max + rise};
}

Region coveredRegion(const Config& config) {
  return config.compensation == Compensation::kScroll ? sweptRegion(config.region) : config.region;
}

/// The echoes of a block, one after the other.
DONEX_WIDE_LOOPS void interleave(const EchoBlock& block, Eigen::Vector3f* echoes) {
  auto* xyz = reinterpret_cast<float*>(echoes);
  for (int i = 0; i < block.count; ++i) {
    xyz[3 * i] = block.x[i];
    xyz[3 * i + 1] = block.y[i];
    xyz[3 * i + 2] = block.z[i];
  }
}

DONEX_WIDE_LOOPS void scaleAll(const Eigen::Vector3f* echoes, std::size_t count, float scale, Eigen::Vector3f* scaled,
                               std::uint8_t* is_echo) {
  const auto* xyz = reinterpret_cast<const float*>(echoes);
  auto* to = reinterpret_cast<float*>(scaled);
  for (std::size_t i = 0; i < 3 * count; ++i) to[i] = xyz[i] * scale;
  for (std::size_t i = 0; i < count; ++i) is_echo[i] = static_cast<std::uint8_t>(!std::isnan(xyz[3 * i]));
}

}  // namespace

double reachOf(const Region& region) {
  return std::hypot(std::max(-region.x_min, region.x_max), std::max(-region.y_min, region.y_max));
}

Eigen::Vector3d GridWindow::extentOf(const Config& config) {
  const Region covered = coveredRegion(config);
  const Eigen::Array3d size(covered.x_max - covered.x_min, covered.y_max - covered.y_min,
                            covered.z_max - covered.z_min);
  // One brick more than the region: the window's lower corner is rounded down to whole bricks.
  return kBrick * ((size / (config.voxel_size * kBrick)).ceil() + 1.0);
}

GridWindow::GridWindow(const Config& config)
    : compensation_(config.compensation),
      voxel_size_(config.voxel_size),
      region_(config.region),
      extent_(extentOf(config).cast<int>()) {
  const Region covered = coveredRegion(config);
  const Eigen::Vector3d low(covered.x_min, covered.y_min, covered.z_min);
  for (int axis = 0; axis < 3; ++axis) min_index_[axis] = floorToBrick(low[axis] / voxel_size_);
}

void GridWindow::moveTo(const Eigen::Isometry3d& odom_from_base) {
  if (compensation_ == Compensation::kResample) {
    odom_from_grid_ = odom_from_base;
    return;
  }
  const Region swept = sweptRegion(region_);
  const Eigen::Vector3d low = odom_from_base.translation() + Eigen::Vector3d(swept.x_min, swept.y_min, swept.z_min);
  for (int axis = 0; axis < 3; ++axis) min_index_[axis] = floorToBrick(low[axis] / voxel_size_);
}

/// The vehicle's pose in the grid; exact where the grid lies at that very pose.
Eigen::Isometry3d GridWindow::gridFrom(const Eigen::Isometry3d& odom_from_base) const {
  if (compensation_ == Compensation::kScroll) return odom_from_base;
  const bool is_there = odom_from_base.matrix() == odom_from_grid_.matrix();
  return is_there ? Eigen::Isometry3d::Identity() : odom_from_grid_.inverse() * odom_from_base;
}

Placement GridWindow::placementOf(const Scan& scan) const {
  // Only the short way from window corner to echo is left to single precision.
  Eigen::Isometry3d window_from_base = gridFrom(scan.odom_from_base);
  window_from_base.translation() -= min_index_.cast<double>() * voxel_size_;
  const Eigen::Isometry3d window_from_sensor = window_from_base * scan.base_from_sensor;
  Placement placement;
  placement.rotation = (window_from_sensor.linear() / voxel_size_).cast<float>();
  placement.origin = (window_from_sensor.translation() / voxel_size_).cast<float>();
  placement.extent = extent_.cast<float>();
  placement.mounting = scan.base_from_sensor.linear().cast<float>();
  placement.mounted_at = scan.base_from_sensor.translation().cast<float>();
  placement.region_low = Eigen::Vector3d(region_.x_min, region_.y_min, region_.z_min).cast<float>();
  placement.region_high = Eigen::Vector3d(region_.x_max, region_.y_max, region_.z_max).cast<float>();
  return placement;
}

void GridWindow::beginScan(const Scan& scan, GridScan& result) const {
  result.origin = placementOf(scan).origin;
  resizeTo(result.echoes, scan.echoes.size());
  resizeTo(result.inside, scan.echoes.size());
}

void GridWindow::enterSome(const Scan& scan, std::size_t first, std::size_t last, GridScan& result) const {
  const auto keep = [&](std::size_t begin, const EchoBlock& block) {
    interleave(block, result.echoes.data() + begin);
    std::copy_n(block.observed.data(), block.count, result.inside.data() + begin);
  };
  forEachBlock(placementOf(scan), scan.echoes, first / EchoBlock::kSize, blocksOf(last), keep);
}

GridOutline GridWindow::outline() const {
  const Eigen::Vector3d low = min_index_.cast<double>() * voxel_size_;
  return {odom_from_grid_, low, low + extent_.cast<double>() * voxel_size_};
}

void placePoints(const GridWindow& window, const GridScan& scan, std::vector<Eigen::Vector3f>& points,
                 std::vector<std::uint8_t>& is_echo) {
  resizeTo(points, scan.echoes.size());
  resizeTo(is_echo, scan.echoes.size());
  placeSomePoints(window, scan, 0, scan.echoes.size(), points, is_echo);
}

void placeSomePoints(const GridWindow& window, const GridScan& scan, std::size_t first, std::size_t last,
                     std::vector<Eigen::Vector3f>& points, std::vector<std::uint8_t>& is_echo) {
  scaleAll(scan.echoes.data() + first, last - first, static_cast<float>(window.voxelSize()), points.data() + first,
           is_echo.data() + first);
}

bool isBefore(const Index3& a, const Index3& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

std::vector<Eigen::Vector3f> cellCenters(const GridWindow& window, const GridScan& scan,
                                         const std::vector<std::uint8_t>& marked) {
  std::vector<Index3> voxels;
  for (std::size_t i = 0; i < marked.size(); ++i) {
    if (marked[i] != 0 && scan.inside[i] != 0) voxels.push_back(voxelOf(scan.echoes[i]));
  }
  return cellCenters(window, std::move(voxels));
}

std::vector<Eigen::Vector3f> cellCenters(const GridWindow& window, std::vector<Index3> voxels) {
  std::sort(voxels.begin(), voxels.end(), isBefore);
  voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
  std::vector<Eigen::Vector3f> centers;
  centers.reserve(voxels.size());
  for (const Index3& voxel : voxels) {
    centers.emplace_back((window.odomFromGrid() * window.indexToCenter(voxel)).cast<float>());
  }
  return centers;
}

}  // namespace donex
