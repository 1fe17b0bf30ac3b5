#include "io/odometry_path.h"

#include <algorithm>
#include <cmath>

#include "core/pi.h"

namespace donex {
namespace {

Twist twistBetween(const Pose& from, const Pose& to, double duration, const Pose& at) {
  const Eigen::AngleAxisd turn((from.orientation.conjugate() * to.orientation).normalized());
  // The short way round, as slerp goes.
  const double angle = turn.angle() > kPi ? turn.angle() - 2.0 * kPi : turn.angle();
  return {at.orientation.conjugate() * ((to.position - from.position) / duration), turn.axis() * (angle / duration)};
}

/// The poses of a sequence as a path in time.
class Path {
 public:
  Path(const std::vector<double>& stamps, const std::vector<Pose>& poses) : stamps_(stamps), poses_(poses) {}

  OdometryPoint at(double stamp) const {
    if (stamps_.size() == 1) return {stamp, poses_.front(), Twist()};
    const std::size_t i = intervalOf(stamp);
    OdometryPoint point;
    point.stamp = stamp;
    point.odom_from_base = interpolate(poses_[i], poses_[i + 1], (stamp - stamps_[i]) / duration(i));
    point.twist = twistIn(i, point.odom_from_base);
    const bool at_bend = stamp == stamps_[i] && i > 0;
    if (at_bend) {  // between two velocities: their mean
      const Twist before = twistIn(i - 1, point.odom_from_base);
      point.twist.linear = 0.5 * (point.twist.linear + before.linear);
      point.twist.angular = 0.5 * (point.twist.angular + before.angular);
    }
    return point;
  }

 private:
  double duration(std::size_t i) const { return stamps_[i + 1] - stamps_[i]; }
  Twist twistIn(std::size_t i, const Pose& at) const { return twistBetween(poses_[i], poses_[i + 1], duration(i), at); }
  /// The interval that holds the stamp; the first or the last one beyond the ends.
  std::size_t intervalOf(double stamp) const {
    const auto after = std::upper_bound(stamps_.begin() + 1, stamps_.end() - 1, stamp);
    return static_cast<std::size_t>(after - stamps_.begin()) - 1;
  }

  const std::vector<double>& stamps_;
  const std::vector<Pose>& poses_;
};

/// Beyond both ends as far as an offset moves them, and one step more: all scans stay covered.
std::vector<double> extended(const std::vector<double>& stamps, const OdometryRhythm& rhythm) {
  const std::size_t margin = 1 + static_cast<std::size_t>(std::abs(rhythm.offset) * rhythm.rate);
  const double step = 1.0 / rhythm.rate;
  std::vector<double> result;
  for (std::size_t i = 0; i < margin; ++i) result.push_back((i == 0 ? stamps.front() : result.back()) - step);
  std::reverse(result.begin(), result.end());
  result.insert(result.end(), stamps.begin(), stamps.end());
  for (std::size_t i = 0; i < margin; ++i) result.push_back(result.back() + step);
  return result;
}

/// Every interval in equal parts; with an offset also beyond the ends.
std::vector<double> odometryStamps(const std::vector<double>& stamps, const OdometryRhythm& rhythm) {
  std::vector<double> result;
  for (std::size_t i = 0; i + 1 < stamps.size(); ++i) {
    const double duration = stamps[i + 1] - stamps[i];
    const int parts = std::max(1, static_cast<int>(std::lround(duration * rhythm.rate)));
    for (int part = 0; part < parts; ++part) result.push_back(stamps[i] + duration * part / parts);
  }
  result.push_back(stamps.back());
  if (rhythm.offset == 0.0) return result;
  result = extended(result, rhythm);
  for (double& stamp : result) stamp += rhythm.offset;
  return result;
}

}  // namespace

std::vector<OdometryPoint> odometryAlong(const std::vector<double>& stamps, const std::vector<Pose>& poses,
                                         const OdometryRhythm& rhythm) {
  const Path path(stamps, poses);
  std::vector<OdometryPoint> points;
  for (const double stamp : odometryStamps(stamps, rhythm)) points.push_back(path.at(stamp));
  return points;
}

}  // namespace donex
