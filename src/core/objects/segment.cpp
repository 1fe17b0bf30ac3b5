#include "core/objects/segment.h"

#include <limits>

namespace donex {
namespace {

constexpr double kLongest = 25.0;     // [m]
constexpr double kLong = 2.0;         // [m]
constexpr double kLeastShare = 0.15;  // of all echoes that must be new
constexpr double kMost = 0.5;         // of all echoes must be new where they are not surely so
constexpr float kOverhead = 2.0F;     // [m] above ground: above people's heads
constexpr double kUpright = 0.3;      // height by length: about that of a car
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
  segment.new_echoes = segment.surely_new_echoes = segment.surface_echoes = segment.settled_echoes = 0;
  segment.lowest = segment.lowest_new = std::numeric_limits<float>::infinity();
  segment.highest_new = -segment.lowest_new;
  for (const std::uint32_t echo : segment.echoes) {
    const Place place = scan.places[echo];
    const float height = scan.has_ground ? scan.heights[echo] : 0.0F;
    segment.lowest = std::min(segment.lowest, height);
    if (isNewPlace(place)) {
      ++segment.new_echoes;
      segment.lowest_new = std::min(segment.lowest_new, height);
      segment.highest_new = std::max(segment.highest_new, height);
    }
    segment.surely_new_echoes += place == Place::kSurelyNew ? 1 : 0;
    segment.surface_echoes += place == Place::kAtSurface ? 1 : 0;
    segment.settled_echoes += place == Place::kSettled ? 1 : 0;
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
  const double fresh = segment.new_echoes, all = static_cast<double>(segment.echoes.size());
  const bool enough = segment.new_echoes >= config.min_echoes && !isTooLong(segment);
  const bool outweighs = fresh > config.new_share * (fresh + segment.settled_echoes + segment.surface_echoes);
  const bool surely = segment.surely_new_echoes >= std::max<double>(config.min_echoes, kLeastShare * all);
  return enough && outweighs && fresh > kLeastShare * all && (surely || fresh >= kMost * all);
}

bool isNewOverhead(const Segment& segment, const Eigen::Vector3d& sensor) {
  const double distance = (segment.center() - sensor).norm();
  const double thickness = segment.highest_new - segment.lowest_new;
  return segment.lowest_new > kOverhead && thickness < kThinAngle * distance;
}

bool isUpright(const Segment& segment) {
  return segment.extent().z() > kUpright * segment.extent().head<2>().maxCoeff();
}

bool isThin(const Segment& segment, const Eigen::Vector3d& sensor) {
  const double distance = (segment.center() - sensor).norm();
  return distance < kThinReach && segment.extent().z() < kThinAngle * distance;
}

}  // namespace donex
