#include "simulation/track.h"

#include <algorithm>
#include <cmath>

namespace donex::simulation {
namespace {

constexpr double kTrackBegin = -1.0;  // [s]
constexpr double kTrackEnd = 80.0;    // [s]
constexpr double kTrackStep = 0.2;    // [s]

/// Do two upright rectangles come closer than `gap` along the first one's way?
bool collide(const PathPoint& a, const Eigen::Vector2d& half_a, const PathPoint& b, const Eigen::Vector2d& half_b,
             double gap) {
  const Eigen::Vector2d apart = b.position - a.position;
  const double c = std::abs(std::cos(b.yaw - a.yaw));
  const double s = std::abs(std::sin(b.yaw - a.yaw));
  const double along = half_a.x() + c * half_b.x() + s * half_b.y() + gap;
  const double across = half_a.y() + s * half_b.x() + c * half_b.y() + 0.1;
  return std::abs(apart.dot(a.forward())) < along && std::abs(apart.dot(a.left())) < across;
}

}  // namespace

Track trackOf(const Course& course, const Eigen::Vector2d& half) {
  Track track{{}, half};
  for (double time = kTrackBegin; time < kTrackEnd; time += kTrackStep) track.places.push_back(course.at(time));
  return track;
}

bool stayClear(const Track& a, const Track& b, double horizon) {
  constexpr double kGap = 1.0;   // [m]
  constexpr double kFar = 22.0;  // no two objects that far apart touch [m]
  const auto steps = static_cast<std::size_t>((std::min(horizon, kTrackEnd) - kTrackBegin) / kTrackStep);
  for (std::size_t i = 0; i < steps; ++i) {
    const bool far = (a.places[i].position - b.places[i].position).squaredNorm() > kFar * kFar;
    if (!far && collide(a.places[i], a.half, b.places[i], b.half, kGap)) return false;
  }
  return true;
}

}  // namespace donex::simulation
