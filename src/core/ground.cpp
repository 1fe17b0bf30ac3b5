#include "donex/core/ground.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace donex {
namespace {

constexpr float kCell = 0.8F;            // [m]
constexpr int kReach = 2;                // cells over which the ground is continued
constexpr float kRoughness = 0.15F;      // [m] ground may rise or fall this much from cell to cell anyway: kerbs
constexpr float kSlope = 0.08F;          // and this much a metre since it was last seen
constexpr float kLargestStep = 0.4F;     // [m] never more
constexpr float kStartUncertainty = 4.0F;  // [m] as if the ground had been seen last this far away
constexpr float kStartRadius = 7.0F;     // [m] the cells in it tell where the ground starts,
constexpr std::size_t kStartCells = 24;  // but never fewer than these
constexpr float kNone = std::numeric_limits<float>::infinity();

int squaredDistance(int cell, int width) {
  const int x = cell % width - width / 2, y = cell / width - width / 2;
  return x * x + y * y;
}

}  // namespace

Ground::Ground(double reach) : width_(2 * static_cast<int>(std::ceil(reach / static_cast<double>(kCell))) + 1) {
  const auto cells = static_cast<std::size_t>(width_) * static_cast<std::size_t>(width_);
  lowest_.resize(cells);
  ground_.resize(cells, kNone);
  unseen_.resize(cells, 0.0F);
  outwards_.resize(cells);
  std::iota(outwards_.begin(), outwards_.end(), 0);
  std::stable_sort(outwards_.begin(), outwards_.end(),
                   [&](int a, int b) { return squaredDistance(a, width_) < squaredDistance(b, width_); });
}

int Ground::cellOf(const Eigen::Vector3f& point) const {
  const Eigen::Vector3f offset = (point - sensor_) / kCell;
  const int x = static_cast<int>(std::floor(offset.x() + 0.5F)) + width_ / 2;
  const int y = static_cast<int>(std::floor(offset.y() + 0.5F)) + width_ / 2;
  const bool inside = x >= 0 && x < width_ && y >= 0 && y < width_;
  return inside ? y * width_ + x : -1;
}

void Ground::estimate(const Eigen::Vector3f& sensor, const std::vector<Eigen::Vector3f>& echoes,
                      const std::vector<std::uint8_t>& is_echo) {
  sensor_ = sensor;
  std::fill(lowest_.begin(), lowest_.end(), kNone);
  std::fill(ground_.begin(), ground_.end(), kNone);
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    if (is_echo[i] == 0) continue;
    const int cell = cellOf(echoes[i]);
    if (cell < 0) continue;
    float& lowest = lowest_[static_cast<std::size_t>(cell)];
    lowest = std::min(lowest, echoes[i].z());
  }
  const float start = startingHeight();
  if (start == kNone) return;
  for (const int cell : outwards_) {
    const auto i = static_cast<std::size_t>(cell);
    const Continuation expected = continueTo(cell, start);
    const float step = std::min(kRoughness + kSlope * expected.unseen, kLargestStep);
    const bool continues = std::abs(lowest_[i] - expected.height) < step;
    ground_[i] = continues ? lowest_[i] : expected.height;
    unseen_[i] = continues ? 0.0F : expected.unseen;
  }
}

float Ground::startingHeight() {
  near_.clear();
  constexpr auto kRadius = static_cast<int>(kStartRadius / kCell);
  for (const int cell : outwards_) {
    const bool enough = near_.size() >= kStartCells && squaredDistance(cell, width_) > kRadius * kRadius;
    if (enough) break;
    const float lowest = lowest_[static_cast<std::size_t>(cell)];
    if (lowest != kNone) near_.push_back(lowest);
  }
  if (near_.empty()) return kNone;
  // A third from below: passes by stray echoes beneath the ground, and by parked cars on both sides.
  const auto third = near_.begin() + static_cast<std::ptrdiff_t>(near_.size() / 3);
  std::nth_element(near_.begin(), third, near_.end());
  return *third;
}

Ground::Continuation Ground::continueTo(int cell, float start) const {
  const int x = cell % width_, y = cell / width_;
  const int own_distance = squaredDistance(cell, width_);
  float sum = 0.0F, weights = 0.0F, unseen = kNone;
  for (int dy = -kReach; dy <= kReach; ++dy) {
    for (int dx = -kReach; dx <= kReach; ++dx) {
      const int nx = x + dx, ny = y + dy;
      if (nx < 0 || nx >= width_ || ny < 0 || ny >= width_) continue;
      const int neighbour = ny * width_ + nx;
      if (squaredDistance(neighbour, width_) >= own_distance) continue;
      const float away = kCell * std::sqrt(static_cast<float>(dx * dx + dy * dy));
      const float since_seen = unseen_[static_cast<std::size_t>(neighbour)] + away;
      const float weight = 1.0F / (since_seen * since_seen);
      sum += weight * ground_[static_cast<std::size_t>(neighbour)];
      weights += weight;
      unseen = std::min(unseen, since_seen);
    }
  }
  if (weights > 0.0F) return {sum / weights, unseen};
  return {start, kStartUncertainty};
}

float Ground::heightOf(const Eigen::Vector3f& point) const {
  const int cell = cellOf(point);
  if (cell < 0) return kNone;
  const float ground = ground_[static_cast<std::size_t>(cell)];
  return ground == kNone ? kNone : point.z() - ground;
}

std::size_t Ground::memoryBytes() const {
  return outwards_.capacity() * sizeof(int) + (lowest_.capacity() + ground_.capacity() + unseen_.capacity() + near_.capacity()) * sizeof(float);
}

}  // namespace donex
