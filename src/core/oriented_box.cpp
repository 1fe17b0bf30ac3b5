#include "donex/core/oriented_box.h"

#include <cmath>
#include <limits>

namespace donex {
namespace {

constexpr double kSurelyMoving = 1.0;  // [m/s] from here on the velocity tells the direction

double mainAxis(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector3d& p : points) mean += p.head<2>();
  mean /= static_cast<double>(points.size());
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector2d d = p.head<2>() - mean;
    xx += d.x() * d.x(), xy += d.x() * d.y(), yy += d.y() * d.y();
  }
  return 0.5 * std::atan2(2.0 * xy, xx - yy);
}

}  // namespace

void fitBox(const std::vector<std::uint32_t>& indices, const std::vector<Eigen::Vector3f>& points,
            const Eigen::Isometry3d& odom_from_points, const Eigen::Vector3d& velocity, Object& object) {
  std::vector<Eigen::Vector3d> in_odom;
  in_odom.reserve(indices.size());
  for (const std::uint32_t i : indices) in_odom.push_back(odom_from_points * points[i].cast<double>());
  const bool moving = velocity.head<2>().norm() > kSurelyMoving;
  const double yaw = moving ? std::atan2(velocity.y(), velocity.x()) : mainAxis(in_odom);
  const Eigen::Matrix3d axes = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Eigen::Vector3d& p : in_odom) {
    const Eigen::Vector3d along = axes.transpose() * p;
    low = low.cwiseMin(along);
    high = high.cwiseMax(along);
  }
  object.odom_from_box.linear() = axes;
  object.odom_from_box.translation() = axes * (0.5 * (low + high));
  object.size = high - low;
}

}  // namespace donex
