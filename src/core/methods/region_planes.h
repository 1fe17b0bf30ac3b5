// The ground as one plane a region (Asvadi et al. 2016, section 3).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace donex {

/// Regions lie one behind the other, outwards from the sensor, in eight directions, each longer than the one before.
/// Each is fitted among the echoes near the plane of the region before it; a plane that tilts or jumps against that
/// one too much is not believed, and the one before goes on.
class RegionPlanes {
 public:
  /// Points [m] in a frame whose z points up; those with `is_echo` 0 are left out.
  void fit(const Eigen::Vector3f& sensor, const std::vector<Eigen::Vector3f>& points,
           const std::vector<std::uint8_t>& is_echo);

  /// Height above the plane of the point's region [m].
  float heightOf(const Eigen::Vector3f& point) const;

  static constexpr int kSectors = 8;
  static constexpr std::array<float, 7> kRingEnds{6.0F, 11.0F, 18.0F, 27.0F, 38.0F, 52.0F, 80.0F};  // [m]

 private:
  /// z = slope_x * x + slope_y * y + height, relative to the sensor.
  struct Plane {
    float slope_x = 0.0F, slope_y = 0.0F, height = 0.0F;
    float at(const Eigen::Vector3f& p) const { return slope_x * p.x() + slope_y * p.y() + height; }
  };
  using Points = std::vector<Eigen::Vector3f>;

  static std::size_t regionOf(const Eigen::Vector3f& from_sensor);
  static float startingHeight(const Points& near_points);
  static Plane fitRegion(const Points& points, const Plane& before, float border);

  Eigen::Vector3f sensor_ = Eigen::Vector3f::Zero();
  std::array<Points, kSectors * kRingEnds.size()> points_;
  std::array<Plane, kSectors * kRingEnds.size()> planes_;
};

}  // namespace donex
