#include "ros/no_returns.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace donex {
namespace {

/// Far nearer than any sensor measures, and more than a transform's rounding [m].
constexpr float kAtSensor = 0.03F;

/// Of the largest range: rounding of coordinates, and 1 cm at 100 m.
constexpr float kShell = 1e-4F;

/// So many echoes there, and this share of all, are no accident.
constexpr std::size_t kPile = 50;
constexpr double kPileShare = 0.01;

/// With fewer others the sensor may as well stand in the middle of a round room.
constexpr double kLeastOthers = 0.1;

const Eigen::Vector3f kNothing = Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());

/// Whether a range, squared as `largest` is, lies in the shell.
bool isInShell(float range, float largest) { return range > largest * (1.0F - kShell) * (1.0F - kShell); }

}  // namespace

NoReturns removeNoReturns(const Eigen::Vector3f& sensor, std::vector<Eigen::Vector3f>& echoes) {
  NoReturns found;
  std::size_t measured = 0, near_largest = 0;  // the second at least as many as lie in the shell
  float largest = 0.0F;                        // squared
  for (Eigen::Vector3f& echo : echoes) {
    const float range = (echo - sensor).squaredNorm();
    if (!std::isfinite(range)) continue;
    if (range < kAtSensor * kAtSensor) {
      echo = kNothing;
      ++found.at_sensor;
      continue;
    }
    ++measured;
    if (!isInShell(range, largest)) continue;
    near_largest = isInShell(largest, range) ? near_largest + 1 : 1;
    largest = std::max(largest, range);
  }
  const auto is_at_end = [&](const Eigen::Vector3f& echo) {
    const float range = (echo - sensor).squaredNorm();
    return std::isfinite(range) && isInShell(range, largest);
  };
  if (near_largest < kPile) return found;
  const auto pile = static_cast<std::size_t>(std::count_if(echoes.begin(), echoes.end(), is_at_end));
  const double share = static_cast<double>(pile) / static_cast<double>(measured);
  const bool is_pile = pile >= kPile && share >= kPileShare && 1.0 - share >= kLeastOthers;
  if (!is_pile) return found;
  found.at_largest_range = pile;
  found.largest_range = std::sqrt(largest);
  std::replace_if(echoes.begin(), echoes.end(), is_at_end, kNothing);
  return found;
}

}  // namespace donex
