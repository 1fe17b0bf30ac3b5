#include "ros/origin_watch.h"

#include <cmath>

#include <fmt/format.h>

#include "core/sight/ring_apex.h"
#include "ros/conversions.h"

namespace donex {

bool liesOnTheGround(const std::vector<Eigen::Vector3f>& echoes) {
  constexpr float kNear = 2.0F, kFar = 6.0F;       // around the origin [m]: there the ground is flat
  constexpr float kLevel = 0.08F, kBelow = 0.15F;  // of the ground [m]
  constexpr std::size_t kEnough = 200;             // echoes
  std::size_t all = 0, level = 0, below = 0;
  for (const Eigen::Vector3f& echo : echoes) {
    const float range = echo.head<2>().norm();
    const bool is_near = range > kNear && range < kFar;  // never with NaN
    if (!is_near) continue;
    ++all;
    level += std::abs(echo.z()) < kLevel ? 1U : 0U;
    below += echo.z() < -kBelow ? 1U : 0U;
  }
  return all >= kEnough && 10 * level > 3 * all && 50 * below < all;
}

std::string OriginWatch::follow(const sensor_msgs::PointCloud2& cloud, const CloudLayout& layout,
                                const std::vector<Eigen::Vector3f>& echoes) {
  if (frame_.empty()) frame_ = cloud.header.frame_id;
  if (is_settled_ || frame_ != cloud.header.frame_id) return "";
  if (layout.ring) parseRings(cloud, layout, rings_);
  if (const auto apex = layout.ring ? findRingApex(echoes, rings_) : std::nullopt) return followApex(*apex, cloud);
  agreeing_ = 0;
  on_the_ground_ = liesOnTheGround(echoes) ? on_the_ground_ + 1 : 0;
  if (on_the_ground_ < kCertain) return "";
  is_settled_ = true;
  return "the clouds are told in the vehicle's frame '" + cloud.header.frame_id +
         "', and its origin lies on the ground, where no sensor is: set sensor_frame, or origin_x, origin_y and "
         "origin_z, to where it is";
}

std::string OriginWatch::followApex(const Eigen::Vector3d& apex, const sensor_msgs::PointCloud2& cloud) {
  agreeing_ = agreeing_ > 0 && (apex - apex_).norm() < kSame ? agreeing_ + 1 : 1;
  apex_ = apex;
  if (agreeing_ < kAgreeing) return "";
  is_settled_ = true;
  if (apex.norm() < kOwnOrigin) return "";
  found_ = apex;
  return fmt::format(
      "the clouds are told in the vehicle's frame '{}', but their rings meet at x {:.2f}, y {:.2f}, z {:.2f} m: lines "
      "of sight begin there from now on; set sensor_frame, or origin_x, origin_y and origin_z, to begin there at once",
      cloud.header.frame_id, apex.x(), apex.y(), apex.z());
}

}  // namespace donex
