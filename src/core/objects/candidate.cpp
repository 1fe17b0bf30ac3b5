#include "core/objects/candidate.h"

#include <limits>

namespace donex {
namespace {

constexpr double kLongest = 25.0;     // [m]
constexpr double kLong = 2.0;         // [m]
constexpr double kLeastShare = 0.15;  // of all echoes that must be new
constexpr double kAround = 0.2;       // [m]
constexpr double kOtherView = 0.5;    // share of the extent that another view of the same thing may not show
constexpr double kFrayed = 0.7;       // [m] and as much at its ends, where few echoes hit: that counts for small things
constexpr double kThinAngle = 0.02;   // [rad]
constexpr double kThinReach = 20.0;   // [m] farther away beams are too sparse to tell

}  // namespace

bool Expected::isLong() const { return extent.head<2>().maxCoeff() > kLong; }

bool Expected::looksLike(const Candidate& candidate) const {
  return (candidate.center() - center).norm() <= kFollowed && alike(extent, candidate.extent());
}

bool Expected::isWithin(const Candidate& candidate) const {
  const bool inside =
      ((center - candidate.low).array() > -kAround).all() && ((candidate.high - center).array() > -kAround).all();
  return inside && !looksLike(candidate);
}

void describeEchoes(const JudgedScan& scan, Candidate& candidate) {
  candidate.low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  candidate.high = -candidate.low;
  candidate.new_echoes = candidate.settled_echoes = 0;
  for (const std::uint32_t echo : candidate.echoes) {
    candidate.new_echoes += scan.places[echo] == Place::kNew ? 1 : 0;
    candidate.settled_echoes += scan.places[echo] == Place::kSettled ? 1 : 0;
    const Eigen::Vector3d in_odom = scan.odom_from_points * scan.points[echo].cast<double>();
    candidate.low = candidate.low.cwiseMin(in_odom);
    candidate.high = candidate.high.cwiseMax(in_odom);
  }
}

bool alike(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return ((a - b).array().abs() <= (kOtherView * a.cwiseMax(b)).array() + kFrayed).all();
}

bool isTooLong(const Candidate& candidate) { return candidate.extent().maxCoeff() > kLongest; }

bool isMostlySettled(const Candidate& candidate) {
  return 2 * static_cast<std::size_t>(candidate.settled_echoes) > candidate.echoes.size();
}

bool isNew(const Candidate& candidate, const ObjectConfig& config) {
  const double fresh = candidate.new_echoes;
  const bool enough = candidate.new_echoes >= config.min_echoes && !isTooLong(candidate);
  const bool outweighs = fresh > config.new_share * (fresh + candidate.settled_echoes);
  return enough && outweighs && fresh > kLeastShare * static_cast<double>(candidate.echoes.size());
}

bool isThin(const Candidate& candidate, const Eigen::Vector3d& sensor) {
  const double distance = (candidate.center() - sensor).norm();
  return distance < kThinReach && candidate.extent().z() < kThinAngle * distance;
}

}  // namespace donex
