#include "donex/core/grid_window.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace donex {
namespace {

/// The vehicle may lean this far before echoes at the region's far end leave a scrolling grid [sin].
constexpr double kLargestTilt = 0.17;  // 10 degrees

int floorToBrick(double voxels) {
  return GridWindow::kBrick * static_cast<int>(std::floor(voxels / GridWindow::kBrick));
}

double farthestCorner(const Region& r) {
  return std::hypot(std::max(-r.x_min, r.x_max), std::max(-r.y_min, r.y_max));
}

/// The region, as a box around the vehicle in which it stays however the vehicle turns [m].
Region sweptRegion(const Region& r) {
  const double reach = farthestCorner(r);
  const double rise = kLargestTilt * reach;
  return {-reach, reach, -reach, reach, r.z_min - rise, r.z_max + rise};
}

Region coveredRegion(const Config& config) {
  return config.compensation == Compensation::kScroll ? sweptRegion(config.region) : config.region;
}

}  // namespace

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
  const Eigen::Vector3d low =
      odom_from_base.translation() + Eigen::Vector3d(swept.x_min, swept.y_min, swept.z_min);
  for (int axis = 0; axis < 3; ++axis) min_index_[axis] = floorToBrick(low[axis] / voxel_size_);
  grid_from_base_ = odom_from_base;
}

void GridWindow::enter(const Scan& scan, GridScan& result) const {
  // Only the short way from window corner to echo is left to single precision.
  Eigen::Isometry3d window_from_base = grid_from_base_;
  window_from_base.translation() -= min_index_.cast<double>() * voxel_size_;
  const Eigen::Isometry3d window_from_sensor = window_from_base * scan.base_from_sensor;
  const Eigen::Matrix3f rotation = (window_from_sensor.linear() / voxel_size_).cast<float>();
  const Eigen::Vector3f origin = (window_from_sensor.translation() / voxel_size_).cast<float>();
  const Eigen::Matrix3f mounting = scan.base_from_sensor.linear().cast<float>();
  const Eigen::Vector3f mounted_at = scan.base_from_sensor.translation().cast<float>();
  const Eigen::Array3f low = Eigen::Array3d(region_.x_min, region_.y_min, region_.z_min).cast<float>();
  const Eigen::Array3f high = Eigen::Array3d(region_.x_max, region_.y_max, region_.z_max).cast<float>();
  const Eigen::Array3f extent = extent_.cast<float>().array();

  result.origin = origin;
  result.echoes.resize(scan.echoes.size());
  result.inside.resize(scan.echoes.size());
  for (std::size_t i = 0; i < scan.echoes.size(); ++i) {
    const Eigen::Vector3f& echo = scan.echoes[i];
    const bool is_echo = echo.squaredNorm() <= kFarthestEcho * kFarthestEcho;  // false for NaN
    if (!is_echo) {
      result.echoes[i].setConstant(std::numeric_limits<float>::quiet_NaN());
      result.inside[i] = 0;
      continue;
    }
    const Eigen::Array3f in_base = mounting * echo + mounted_at;
    const Eigen::Vector3f u = rotation * echo + origin;
    result.echoes[i] = u;
    result.inside[i] = (in_base >= low).all() && (in_base < high).all() && (u.array() >= 0.0F).all() &&
                       (u.array() < extent).all();
  }
}

GridOutline GridWindow::outline() const {
  const Eigen::Vector3d low = min_index_.cast<double>() * voxel_size_;
  return {odom_from_grid_, low, low + extent_.cast<double>() * voxel_size_};
}

std::vector<Eigen::Vector3f> cellCenters(const GridWindow& window, const GridScan& scan,
                                         const std::vector<std::uint8_t>& marked) {
  std::vector<Index3> voxels;
  for (std::size_t i = 0; i < marked.size(); ++i) {
    if (marked[i] != 0 && scan.inside[i] != 0) voxels.push_back(voxelOf(scan.echoes[i]));
  }
  const auto before = [](const Index3& a, const Index3& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  };
  std::sort(voxels.begin(), voxels.end(), before);
  voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
  std::vector<Eigen::Vector3f> centers;
  centers.reserve(voxels.size());
  for (const Index3& voxel : voxels) {
    centers.push_back((window.odomFromGrid() * window.indexToCenter(voxel)).cast<float>());
  }
  return centers;
}

}  // namespace donex
