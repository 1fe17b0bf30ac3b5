#include "core/objects/segment.h"

#include <limits>

namespace donex {
namespace {

constexpr double kLongest = 25.0;     // [m]
constexpr double kLong = 2.0;         // [m]
constexpr double kLeastShare = 0.15;  // of all echoes that must be new
constexpr double kAround = 0.2;       // [m]
constexpr double kOtherView = 0.5;    // share of the extent that another view of the same object may not show
constexpr double kFrayed = 0.7;      // [m] and as much at its ends, where few echoes hit: that counts for small objects
constexpr double kThinAngle = 0.02;  // [rad]
constexpr double kThinReach = 20.0;  // [m] farther away beams are too sparse to tell

}  // namespace

bool Prediction::isLong(const Eigen::Vector3d& extent) { return extent.head<2>().maxCoeff() > kLong; }

bool Prediction::looksLike(const Segment& segment) const {
  return (segment.center() - center).norm() <= kFollowed && alike(extent, segment.extent());
}

bool Prediction::isWithin(const Segment& segment) const {
  const bool inside =
      ((center - segment.low).array() > -kAround).all() && ((segment.high - center).array() > -kAround).all();
  return inside && !looksLike(segment);
}

void describeEchoes(const JudgedScan& scan, Segment& segment) {
  segment.low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  segment.high = -segment.low;
  segment.new_echoes = segment.settled_echoes = 0;
  for (const std::uint32_t echo : segment.echoes) {
    segment.new_echoes += scan.places[echo] == Place::kNew ? 1 : 0;
    segment.settled_echoes += scan.places[echo] == Place::kSettled ? 1 : 0;
    const Eigen::Vector3d in_odom = scan.odom_from_points * scan.points[echo].cast<double>();
    segment.low = segment.low.cwiseMin(in_odom);
    segment.high = segment.high.cwiseMax(in_odom);
  }
}

bool alike(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return ((a - b).array().abs() <= (kOtherView * a.cwiseMax(b)).array() + kFrayed).all();
}

bool isTooLong(const Segment& segment) { return segment.extent().maxCoeff() > kLongest; }

bool isMostlySettled(const Segment& segment) {
  return 2 * static_cast<std::size_t>(segment.settled_echoes) > segment.echoes.size();
}

bool isNew(const Segment& segment, const ObjectConfig& config) {
  const double fresh = segment.new_echoes;
  const bool enough = segment.new_echoes >= config.min_echoes && !isTooLong(segment);
  const bool outweighs = fresh > config.new_share * (fresh + segment.settled_echoes);
  return enough && outweighs && fresh > kLeastShare * static_cast<double>(segment.echoes.size());
}

bool isThin(const Segment& segment, const Eigen::Vector3d& sensor) {
  const double distance = (segment.center() - sensor).norm();
  return distance < kThinReach && segment.extent().z() < kThinAngle * distance;
}

}  // namespace donex
