#include "core/objects/oriented_box.h"

#include <cmath>
#include <limits>

namespace donex {
namespace {

constexpr double kDirectedSpeed = 1.0;  // [m/s] from here on the velocity tells the direction

/// Some points of many, odometry frame [m]; transformed whenever they are asked for, so that nothing is kept.
class InOdom {
 public:
  InOdom(const std::pmr::vector<std::uint32_t>& indices, const std::vector<Eigen::Vector3f>& points,
         const Eigen::Isometry3d& odom_from_points)
      : indices_(indices), points_(points), odom_from_points_(odom_from_points) {}

  template <class Visit>
  void each(Visit&& visit) const {
    for (const std::uint32_t i : indices_) visit(Eigen::Vector3d(odom_from_points_ * points_[i].cast<double>()));
  }
  double count() const { return static_cast<double>(indices_.size()); }

 private:
  const std::pmr::vector<std::uint32_t>& indices_;
  const std::vector<Eigen::Vector3f>& points_;
  const Eigen::Isometry3d& odom_from_points_;
};

double mainAxis(const InOdom& points) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  points.each([&](const Eigen::Vector3d& p) { mean += p.head<2>(); });
  mean /= points.count();
  double xx = 0.0, xy = 0.0, yy = 0.0;
  points.each([&](const Eigen::Vector3d& p) {
    const Eigen::Vector2d d = p.head<2>() - mean;
    xx += d.x() * d.x(), xy += d.x() * d.y(), yy += d.y() * d.y();
  });
  return 0.5 * std::atan2(2.0 * xy, xx - yy);
}

}  // namespace

void fitBox(const std::pmr::vector<std::uint32_t>& indices, const std::vector<Eigen::Vector3f>& points,
            const Eigen::Isometry3d& odom_from_points, const Eigen::Vector3d& velocity, Object& object) {
  const InOdom in_odom(indices, points, odom_from_points);
  const bool moving = velocity.head<2>().norm() > kDirectedSpeed;
  const double yaw = moving ? std::atan2(velocity.y(), velocity.x()) : mainAxis(in_odom);
  const Eigen::Matrix3d axes = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  in_odom.each([&](const Eigen::Vector3d& p) {
    const Eigen::Vector3d along = axes.transpose() * p;
    low = low.cwiseMin(along);
    high = high.cwiseMax(along);
  });
  object.odom_from_box.linear() = axes;
  object.odom_from_box.translation() = axes * (0.5 * (low + high));
  object.size = high - low;
}

}  // namespace donex
