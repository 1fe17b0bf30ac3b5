#include "core/motion/track_comparison.h"

#include <algorithm>
#include <cmath>

#include "core/pi.h"

namespace donex {
namespace {

double yawOf(const Eigen::Isometry3d& motion) { return std::atan2(motion(1, 0), motion(0, 0)); }

}  // namespace

double TrackDifference::harm() const {
  constexpr double kDistance = 0.10, kPerWay = 0.012;          // [m], share of the way
  constexpr double kYaw = 0.5 * kPi / 180.0, kPerTurn = 0.02;  // [rad], share of the turn
  return std::max(distance / (kDistance + kPerWay * way), std::abs(yaw) / (kYaw + kPerTurn * std::abs(turn)));
}

TrackDifference differenceBetween(const Poses& given, const Poses& found, std::size_t first, std::size_t last) {
  const Eigen::Isometry3d by_odometry = given[first].inverse() * given[last];
  const Eigen::Isometry3d by_scans = found[first].inverse() * found[last];
  TrackDifference difference;
  for (std::size_t i = first; i < last; ++i) {
    difference.way += (found[i + 1].translation() - found[i].translation()).norm();
  }
  difference.turn = yawOf(by_scans);
  difference.distance = (by_odometry.translation() - by_scans.translation()).head<2>().norm();
  difference.yaw = yawOf(by_odometry.inverse() * by_scans);
  return difference;
}

bool windowBefore(const Poses& found, std::size_t last, const ComparisonWindow& window, std::size_t& first) {
  double way = 0.0;
  std::size_t scans = 0;
  first = last;
  while (first > 0 && scans < window.most_scans) {
    --first;
    ++scans;
    way += (found[first + 1].translation() - found[first].translation()).norm();
    if (scans >= window.scans && way >= window.way) return true;
  }
  return scans >= window.scans;
}

}  // namespace donex
