#include "references.h"

#include <cmath>
#include <map>
#include <string>
#include <tuple>

#include "core/grid/brick_layout.h"
#include "core/grid/grid_window.h"
#include "core/grid/line_of_sight.h"

namespace donex::benchmark {
namespace {

constexpr int kRounds = 20;

/// The window's own place, and from sensor coordinates to it.
struct Placed {
  Eigen::Matrix3f rotation;
  Eigen::Vector3f origin;
};

Placed place(GridWindow& window, const Scan& scan) {
  window.moveTo(scan.odom_from_base);
  const double per_voxel = 1.0 / window.voxelSize();
  const Eigen::Isometry3d grid_from_sensor = scan.odomFromSensor();
  const Eigen::Vector3d origin = grid_from_sensor.translation() * per_voxel - window.minIndex().cast<double>();
  return {(grid_from_sensor.linear() * per_voxel).cast<float>(), origin.cast<float>()};
}

class Floor2d {
 public:
  explicit Floor2d(const Config& config) : window_(config), cells_(cellsIn(window_.extent()), 0) {}

  void operator()(const Scan& scan) {
    const Placed placed = place(window_, scan);
    const int width = window_.extent().x(), depth = window_.extent().y();
    const auto height = static_cast<float>(window_.extent().z());
    for (const Eigen::Vector3f& echo : scan.echoes) {
      const Eigen::Vector3f u = placed.rotation * echo + placed.origin;
      const int x = static_cast<int>(u.x()), y = static_cast<int>(u.y());
      const bool inside = x >= 0 && x < width && y >= 0 && y < depth && u.z() >= 0.0F && u.z() < height;
      if (inside) ++cells_[static_cast<std::size_t>(y * width + x)];
    }
  }

 private:
  static std::size_t cellsIn(const Index3& extent) { return static_cast<std::size_t>(extent.x() * extent.y()); }

  GridWindow window_;
  std::vector<std::uint8_t> cells_;
};

class Floor3d {
 public:
  explicit Floor3d(const Config& config) : window_(config), words_(wordsIn(window_.extent()), 0) {}

  void operator()(const Scan& scan) {
    const Placed placed = place(window_, scan);
    const Index3 extent = window_.extent();
    for (const Eigen::Vector3f& echo : scan.echoes) {
      const Eigen::Vector3f u = placed.rotation * echo + placed.origin;
      const int x = static_cast<int>(u.x()), y = static_cast<int>(u.y()), z = static_cast<int>(u.z());
      const bool inside = x >= 0 && x < extent.x() && y >= 0 && y < extent.y() && z >= 0 && z < extent.z();
      if (!inside) continue;
      const int brick = ((z >> 2) * (extent.y() >> 2) + (y >> 2)) * (extent.x() >> 2) + (x >> 2);
      words_[static_cast<std::size_t>(brick)] |= std::uint64_t{1} << ((x & 3) | (y & 3) << 2 | (z & 3) << 4);
    }
  }

 private:
  static std::size_t wordsIn(const Index3& extent) {
    return static_cast<std::size_t>((extent / GridWindow::kBrick).cast<std::int64_t>().prod());
  }

  GridWindow window_;
  std::vector<std::uint64_t> words_;
};

using Key = std::tuple<int, double, double, const Scans*>;

Key keyOf(int what, const Config& config, const Scans& scans) {
  return {what, config.voxel_size, config.region.x_max, &scans};
}

}  // namespace

Measured floorOf(Method method, const Config& config, const Scans& scans) {
  static std::map<Key, Measured> measured;
  const auto [place, is_new] = measured.try_emplace(keyOf(static_cast<int>(method), config, scans));
  if (!is_new) return place->second;
  if (method == Method::kDonex2d) return place->second = measure(scans, kRounds, Floor2d(config));
  return place->second = measure(scans, kRounds, Floor3d(config));
}

Measured naiveOf(const Config& config, const Scans& scans) {
  static std::map<Key, Measured> measured;
  const auto [place, is_new] = measured.try_emplace(keyOf(-1, config, scans));
  if (!is_new) return place->second;
  GridWindow window(config);
  const BrickLayout layout(window.extent());
  std::vector<std::uint64_t> crossed(layout.slots());
  GridScan in_grid;
  return place->second = measure(scans, 1, [&](const Scan& scan) {
           window.moveTo(scan.odom_from_base);
           window.enter(scan, in_grid);
           for (const Eigen::Vector3f& echo : in_grid.echoes) {
             if (std::isnan(echo.x())) continue;
             for (const Index3& voxel : LineOfSight(in_grid.origin, echo)) {
               if (!window.contains(voxel)) continue;
               const BrickBit at = layout.locate(voxel);
               crossed[at.slot] |= std::uint64_t{1} << at.bit;
             }
           }
         });
}

}  // namespace donex::benchmark
