#include "core/methods/region_planes.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "core/pi.h"

namespace donex {
namespace {

constexpr float kGate = 0.4F;              // from the expected plane to what may be ground [m]
constexpr float kInlier = 0.15F;           // from the fitted plane [m]
constexpr int kRounds = 4;                 // of fitting and leaving out what is far from the fit
constexpr std::size_t kLeast = 20;         // points that make a plane
constexpr float kLargestPlaneTilt = 0.1F;  // between a plane and the one before [tan]
constexpr float kLargestJump = 0.3F;       // at the border between them [m]

}  // namespace

std::size_t RegionPlanes::regionOf(const Eigen::Vector3f& p) {
  const float range = p.head<2>().norm();
  const auto ring = static_cast<std::size_t>(
      std::min<std::ptrdiff_t>(std::upper_bound(kRingEnds.begin(), kRingEnds.end(), range) - kRingEnds.begin(),
                               static_cast<std::ptrdiff_t>(kRingEnds.size()) - 1));
  const float turn = (std::atan2(p.y(), p.x()) + kPiF) / (2.0F * kPiF) * kSectors;
  const auto sector = static_cast<std::size_t>(std::clamp(static_cast<int>(turn), 0, kSectors - 1));
  return sector * kRingEnds.size() + ring;
}

/// The height that most of the low points near the sensor have: the lowest decile.
float RegionPlanes::startingHeight(const Points& near_points) {
  std::vector<float> heights;
  for (const Eigen::Vector3f& p : near_points) heights.push_back(p.z());
  if (heights.empty()) return 0.0F;
  const auto decile = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 10);
  std::nth_element(heights.begin(), decile, heights.end());
  return *decile;
}

RegionPlanes::Plane RegionPlanes::fitRegion(const Points& points, const Plane& before, float border) {
  Plane plane = before;
  float gate = kGate;
  for (int round = 0; round < kRounds; ++round, gate = kInlier) {
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
    Eigen::Vector3d sums = Eigen::Vector3d::Zero();
    std::size_t inliers = 0;
    for (const Eigen::Vector3f& p : points) {
      if (std::abs(p.z() - plane.at(p)) > gate) continue;
      const Eigen::Vector3d row(p.x(), p.y(), 1.0);
      products += row * row.transpose();
      sums += row * static_cast<double>(p.z());
      ++inliers;
    }
    if (inliers < kLeast) return before;
    const Eigen::Vector3f fitted = products.ldlt().solve(sums).cast<float>();
    if (!fitted.allFinite()) return before;
    plane = {fitted.x(), fitted.y(), fitted.z()};
  }
  const float tilt = std::hypot(plane.slope_x - before.slope_x, plane.slope_y - before.slope_y);
  const Eigen::Vector3f at_border = border * points.front().normalized();
  const bool continues =
      tilt <= kLargestPlaneTilt && std::abs(plane.at(at_border) - before.at(at_border)) <= kLargestJump;
  return continues ? plane : before;
}

void RegionPlanes::fit(const Eigen::Vector3f& sensor, const std::vector<Eigen::Vector3f>& points,
                       const std::vector<std::uint8_t>& is_echo) {
  sensor_ = sensor;
  for (Points& region : points_) region.clear();
  Points near_points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (is_echo[i] == 0) continue;
    const Eigen::Vector3f p = points[i] - sensor;
    const float range = p.head<2>().norm();
    if (range > kRingEnds.back()) continue;
    points_[regionOf(p)].push_back(p);
    if (range < kRingEnds[1]) near_points.push_back(p);
  }
  const Plane start{0.0F, 0.0F, startingHeight(near_points)};
  for (std::size_t region = 0; region < planes_.size(); ++region) {
    const std::size_t ring = region % kRingEnds.size();
    const Plane& before = ring == 0 ? start : planes_[region - 1];
    const float border = ring == 0 ? 0.0F : kRingEnds[ring - 1];
    planes_[region] = fitRegion(points_[region], before, border);
  }
}

float RegionPlanes::heightOf(const Eigen::Vector3f& point) const {
  const Eigen::Vector3f p = point - sensor_;
  return p.z() - planes_[regionOf(p)].at(p);
}

}  // namespace donex
