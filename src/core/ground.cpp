#include "donex/core/ground.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace donex {
namespace {

constexpr float kCell = 0.8F;            // [m]
constexpr int kReach = 2;                // cells over which the ground is continued
constexpr float kLargestStep = 0.25F;    // [m] a kerb is ground, a car's sill is not
constexpr float kLargestFirstStep = 0.6F;  // [m] the same right around the sensor, where there is little to continue
constexpr float kStartRadius = 12.0F;    // [m]
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
    const float expected = expectedAt(cell, start);
    const bool is_first = squaredDistance(cell, width_) < 16;
    const float step = is_first ? kLargestFirstStep : kLargestStep;
    const bool continues = std::abs(lowest_[i] - expected) < step;
    ground_[i] = continues ? lowest_[i] : expected;
  }
}

float Ground::startingHeight() {
  near_.clear();
  const int radius = static_cast<int>(kStartRadius / kCell);
  for (const int cell : outwards_) {
    const bool enough = squaredDistance(cell, width_) > radius * radius && !near_.empty();
    if (enough) break;
    if (lowest_[static_cast<std::size_t>(cell)] != kNone) near_.push_back(lowest_[static_cast<std::size_t>(cell)]);
  }
  if (near_.empty()) return kNone;
  // Most cells around a vehicle show ground; a quarter from below passes by stray echoes beneath it.
  const auto quarter = near_.begin() + static_cast<std::ptrdiff_t>(near_.size() / 4);
  std::nth_element(near_.begin(), quarter, near_.end());
  return *quarter;
}

float Ground::expectedAt(int cell, float fallback) const {
  const int x = cell % width_, y = cell / width_;
  const int own_distance = squaredDistance(cell, width_);
  float sum = 0.0F, weights = 0.0F;
  for (int dy = -kReach; dy <= kReach; ++dy) {
    for (int dx = -kReach; dx <= kReach; ++dx) {
      const int nx = x + dx, ny = y + dy;
      if (nx < 0 || nx >= width_ || ny < 0 || ny >= width_) continue;
      const int neighbour = ny * width_ + nx;
      if (squaredDistance(neighbour, width_) >= own_distance) continue;
      const float weight = 1.0F / static_cast<float>(dx * dx + dy * dy);
      sum += weight * ground_[static_cast<std::size_t>(neighbour)];
      weights += weight;
    }
  }
  return weights > 0.0F ? sum / weights : fallback;
}

float Ground::heightOf(const Eigen::Vector3f& point) const {
  const int cell = cellOf(point);
  if (cell < 0) return kNone;
  const float ground = ground_[static_cast<std::size_t>(cell)];
  return ground == kNone ? kNone : point.z() - ground;
}

std::size_t Ground::memoryBytes() const {
  return outwards_.capacity() * sizeof(int) + (lowest_.capacity() + ground_.capacity() + near_.capacity()) * sizeof(float);
}

}  // namespace donex
