// Random motions for the tests of ego motion.
#pragma once

#include <cmath>
#include <random>

#include "donex/motion/ego_motion.h"

namespace donex::testing {

inline Eigen::Vector3d randomVector(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> number(-size, size);
  return {number(random), number(random), number(random)};
}

inline Eigen::Isometry3d randomPose(std::mt19937& random, double size) {
  std::normal_distribution<double> number;
  Eigen::Quaterniond rotation(number(random), number(random), number(random), number(random));
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotation.normalized().toRotationMatrix();
  pose.translation() = randomVector(random, size);
  return pose;
}

inline Twist randomTwist(std::mt19937& random) { return {randomVector(random, 15.0), randomVector(random, 1.0)}; }

inline double rotationBetween(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return Eigen::AngleAxisd(Eigen::Matrix3d(a.linear().transpose() * b.linear())).angle();
}

inline double distanceBetween(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return (a.translation() - b.translation()).norm();
}

/// A vehicle that keeps its twist: the motion every method here must reproduce.
struct SteadyDrive {
  Twist twist;
  Eigen::Isometry3d start = Eigen::Isometry3d::Identity();
  double epoch = 0.0;  // [s]

  Eigen::Isometry3d poseAt(double stamp) const { return start * integrateTwist(twist, stamp - epoch); }
  OdometrySample sampleAt(double stamp) const { return {stamp, poseAt(stamp), twist}; }
};

}  // namespace donex::testing
