// Scans made to be awkward: faces, axes, duplicates, negative coordinates, invalid echoes.
#pragma once

#include <cmath>
#include <limits>
#include <random>

#include "donex/scan.h"

namespace donex::testing {

class RandomScans {
 public:
  /// Every second seed starts in the odometry's origin, so that the first window is the one a grid is made with. Every
  /// third has the sensor in the vehicle's, which keeps axes and faces exact.
  RandomScans(unsigned seed, double voxel_size, float reach) : random_(seed), voxel_size_(voxel_size), reach_(reach) {
    if (seed % 2 == 0) pose_.setIdentity();
    if (seed % 3 == 0) base_from_sensor_.setIdentity();
  }

  /// A scan with up to `most` echoes taken from a vehicle that has moved a little since the last one.
  Scan next(int most) {
    Scan scan;
    scan.stamp = stamp_ += 0.1;
    move();
    scan.odom_from_base = pose_;
    scan.base_from_sensor = base_from_sensor_;
    const int echoes = std::uniform_int_distribution<int>(0, most)(random_);
    for (int i = 0; i < echoes; ++i) scan.echoes.push_back(echo(scan));
    return scan;
  }

 private:
  Eigen::Vector3f echo(const Scan& scan) {
    Eigen::Vector3f p(uniform(-reach_, reach_), uniform(-reach_, reach_), uniform(-reach_ / 3, reach_ / 3));
    const double kind = uniform(0, 1);
    if (kind < 0.1)
      p[pick(3)] = 0.0F;  // in a plane through the sensor
    else if (kind < 0.2)
      p[pick(3)] = p[pick(3)] = 0.0F;  // often along an axis
    else if (kind < 0.35)
      onFaces(p);
    else if (kind < 0.45 && !scan.echoes.empty())
      p = scan.echoes[pickEcho(scan)];
    else if (kind < 0.50 && !scan.echoes.empty())
      p = scan.echoes[pickEcho(scan)] * 0.5F;  // same line of sight
    else if (kind < 0.55)
      p *= 3.0F;  // outside the region
    else if (kind < 0.58)
      p[pick(3)] = std::numeric_limits<float>::quiet_NaN();
    else if (kind < 0.60)
      p[pick(3)] = std::numeric_limits<float>::infinity();
    else if (kind < 0.61)
      p *= 1e6F;
    else if (kind < 0.62)
      p.setZero();
    return p;
  }

  void onFaces(Eigen::Vector3f& p) {
    const auto size = static_cast<float>(voxel_size_);
    for (int axis = 0; axis < 3; ++axis) {
      if (chance(0.7)) p[axis] = std::round(p[axis] / size) * size;
    }
  }

  void move() {
    if (chance(0.3)) return;  // at rest
    if (chance(0.1)) {        // whole voxels, so that faces stay faces
      pose_.linear().setIdentity();
      pose_.translation() = (pose_.translation() / voxel_size_).array().round() * voxel_size_;
      return;
    }
    const Eigen::Vector3d axis = Eigen::Vector3d(uniform(-0.1F, 0.1F), uniform(-0.1F, 0.1F), 1).normalized();
    pose_ = pose_ * Eigen::Translation3d(uniform(-1, 2), uniform(-0.3F, 0.3F), uniform(-0.2F, 0.2F)) *
            Eigen::AngleAxisd(uniform(-0.1F, 0.1F), axis);
    pose_.linear() = Eigen::Quaterniond(pose_.linear()).normalized().toRotationMatrix();
  }

  bool chance(double p) { return std::uniform_real_distribution<double>(0, 1)(random_) < p; }
  float uniform(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }
  int pick(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }
  std::size_t pickEcho(const Scan& scan) {
    return static_cast<std::size_t>(pick(static_cast<int>(scan.echoes.size())));
  }

  std::mt19937 random_;
  double voxel_size_;
  float reach_;
  double stamp_ = 0.0;
  Eigen::Isometry3d base_from_sensor_ =
      Eigen::Translation3d(0.3, -0.1, 0.5) * Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitY());
  Eigen::Isometry3d pose_ = Eigen::Isometry3d(Eigen::Translation3d(-3.7, 2.2, -0.4));
};

}  // namespace donex::testing
