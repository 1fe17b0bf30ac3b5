// Clouds of plane patches for the tests of registration: exact, but for the rounding of floats.
#pragma once

#include <vector>

#include <Eigen/Geometry>

namespace donex::testing {

/// A grid of points `step` [m] apart that starts at `corner` and spans `u` times `v`.
inline void addPatch(const Eigen::Vector3d& corner, const Eigen::Vector3d& u, const Eigen::Vector3d& v, double step,
                     std::vector<Eigen::Vector3d>& points) {
  const auto along = static_cast<int>(u.norm() / step), across = static_cast<int>(v.norm() / step);
  for (int i = 0; i <= along; ++i) {
    for (int j = 0; j <= across; ++j)
      points.emplace_back(corner + i * step * u.normalized() + j * step * v.normalized());
  }
}

/// Walls on four sides and the ground, too far from one another to share a voxel; sloped, so that they lie on no
/// border.
inline std::vector<Eigen::Vector3d> courtyard() {
  std::vector<Eigen::Vector3d> points;
  const Eigen::Vector3d up(0.02, 0.03, 1.0);
  addPatch({-8.0, -8.0, -1.7}, {16.0, 0.1, 0.2}, {0.1, 16.0, -0.3}, 0.21, points);
  addPatch({12.3, -9.0, 1.0}, {0.4, 18.0, 0.0}, 5.0 * up, 0.23, points);
  addPatch({-13.1, -9.0, 1.0}, {-0.3, 18.0, 0.0}, 5.0 * up, 0.23, points);
  addPatch({-9.0, 12.2, 1.0}, {18.0, 0.5, 0.0}, 5.0 * up, 0.23, points);
  addPatch({-9.0, -13.4, 1.0}, {18.0, 0.2, 0.0}, 5.0 * up, 0.23, points);
  return points;
}

/// Two walls and the ground along x, without end as far as the sensor sees.
inline std::vector<Eigen::Vector3d> corridor(double from, double to) {
  std::vector<Eigen::Vector3d> points;
  const Eigen::Vector3d along(to - from, 0.0, 0.0);
  addPatch({from, -2.9, -1.7}, along, {0.0, 5.8, 0.0}, 0.2, points);
  addPatch({from, 6.3, 1.0}, along, {0.0, 0.0, 4.0}, 0.2, points);
  addPatch({from, -6.4, 1.0}, along, {0.0, 0.0, 4.0}, 0.2, points);
  return points;
}

inline std::vector<Eigen::Vector3f> seenFrom(const Eigen::Isometry3d& odom_from_sensor,
                                             const std::vector<Eigen::Vector3d>& points) {
  const Eigen::Isometry3d sensor_from_odom = odom_from_sensor.inverse();
  std::vector<Eigen::Vector3f> echoes;
  echoes.reserve(points.size());
  for (const Eigen::Vector3d& point : points) echoes.push_back((sensor_from_odom * point).cast<float>());
  return echoes;
}

}  // namespace donex::testing
