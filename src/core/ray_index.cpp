#include "donex/core/ray_index.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace donex {
namespace {

constexpr int kAcross = 512;   // bins across one side of the prism
constexpr int kUp = 128;       // bins of height
constexpr float kSteepest = 1.0F;  // tangent of the elevation where the outermost bins begin to collect all the rest
constexpr float kMargin = 1e-5F;   // covers rounding between a direction and the box it crosses

/// A vector as side `side` sees it: depth along the side's axis, then across, then up.
Eigen::Vector3f onSide(int side, const Eigen::Vector3f& p) {
  switch (side) {
    case 0: return {p.x(), p.y(), p.z()};
    case 1: return {p.y(), -p.x(), p.z()};
    case 2: return {-p.x(), -p.y(), p.z()};
    default: return {-p.y(), p.x(), p.z()};
  }
}

int sideOf(const Eigen::Vector3f& p) {
  if (std::abs(p.x()) >= std::abs(p.y())) return p.x() >= 0.0F ? 0 : 2;
  return p.y() >= 0.0F ? 1 : 3;
}

int acrossBin(float u) { return std::clamp(static_cast<int>((u + 1.0F) * (0.5F * kAcross)), 0, kAcross - 1); }
int upBin(float v) {
  const float bounded = std::clamp(v, -kSteepest, kSteepest);
  return std::clamp(static_cast<int>((bounded + kSteepest) * (0.5F * kUp / kSteepest)), 0, kUp - 1);
}
int binIndex(int side, int u, int v) { return (side * kAcross + u) * kUp + v; }

}  // namespace

int RayIndex::binOf(const Eigen::Vector3f& direction) const {
  const int side = sideOf(direction);
  const Eigen::Vector3f p = onSide(side, direction);
  if (p.x() <= 0.0F) return binIndex(0, 0, p.z() < 0.0F ? 0 : kUp - 1);  // straight up or down
  return binIndex(side, acrossBin(p.y() / p.x()), upBin(p.z() / p.x()));
}

void RayIndex::build(const Eigen::Vector3f& origin, const std::vector<Eigen::Vector3f>& echoes) {
  constexpr std::uint32_t kNoBin = std::numeric_limits<std::uint32_t>::max();
  origin_ = origin;
  first_.assign(kSides * kAcross * kUp + 1, 0);
  farthest_.assign(kSides * kAcross * kUp, -1.0F);
  bin_of_echo_.resize(echoes.size());
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    const Eigen::Vector3f direction = echoes[i] - origin;
    if (!(direction.squaredNorm() > 0.0F)) {  // no echo, or in the sensor itself
      bin_of_echo_[i] = kNoBin;
      continue;
    }
    const auto bin = static_cast<std::uint32_t>(binOf(direction));
    bin_of_echo_[i] = bin;
    ++first_[bin];
    const float depth = std::max(std::abs(direction.x()), std::abs(direction.y()));
    farthest_[bin] = std::max(farthest_[bin], depth);
  }
  // Counts become ends; filling backwards turns the ends into starts.
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  rays_.resize(first_.back());
  for (std::size_t i = echoes.size(); i-- > 0;) {
    if (bin_of_echo_[i] != kNoBin) rays_[--first_[bin_of_echo_[i]]] = echoes[i];
  }
}

/// Shows `visit(bin, nearest)` the bins that a line of sight through the box can lie in, with the
/// depth the line must reach to touch it, until it returns true.
template <class Visit>
bool RayIndex::anyBin(const Eigen::Vector3f& low, const Eigen::Vector3f& high, Visit&& visit) const {
  for (int side = 0; side < kSides; ++side) {
    const Eigen::Vector3f a = onSide(side, low), b = onSide(side, high);
    const Eigen::Vector3f first = a.cwiseMin(b), last = a.cwiseMax(b);
    const float far_depth = last.x();
    const float least_across = std::max({first.y(), -last.y(), 0.0F});
    const bool on_this_side = far_depth >= 0.0F && least_across <= far_depth * (1.0F + kMargin) + kMargin;
    if (!on_this_side) continue;
    const float near_depth = std::max({first.x(), least_across, 0.0F}) * (1.0F - kMargin);
    // Directions spread most at the near face, unless the box does not reach the axis on that flank.
    const auto lowest = [&](float w) { return w < 0.0F ? w / near_depth : w / far_depth; };
    const auto highest = [&](float w) { return w > 0.0F ? w / near_depth : w / far_depth; };
    const bool at_sensor = near_depth <= kMargin;
    const float u_low = at_sensor ? -1.0F : lowest(first.y()), u_high = at_sensor ? 1.0F : highest(last.y());
    const float v_low = at_sensor ? -kSteepest : lowest(first.z());
    const float v_high = at_sensor ? kSteepest : highest(last.z());
    const auto wider = [](float x, float by) { return x + by * kMargin * (1.0F + std::abs(x)); };
    const int u_first = acrossBin(std::max(wider(u_low, -1), -1.0F)), u_last = acrossBin(std::min(wider(u_high, 1), 1.0F));
    const int v_first = upBin(wider(v_low, -1)), v_last = upBin(wider(v_high, 1));
    for (int u = u_first; u <= u_last; ++u) {
      for (int v = v_first; v <= v_last; ++v) {
        if (visit(static_cast<std::size_t>(binIndex(side, u, v)), near_depth)) return true;
      }
    }
  }
  return false;
}

bool RayIndex::seesThrough(const Index3& voxel) const {
  const Eigen::Vector3f low = voxel.cast<float>() - origin_;
  const Eigen::Vector3f high = low + Eigen::Vector3f::Ones();
  return anyBin(low, high, [&](std::size_t bin, float near_depth) {
    if (farthest_[bin] < near_depth) return false;
    return std::any_of(rays_.begin() + first_[bin], rays_.begin() + first_[bin + 1],
                       [&](const Eigen::Vector3f& echo) { return LineOfSight(origin_, echo).crosses(voxel); });
  });
}

bool RayIndex::maySeeThrough(const Index3& corner, int edge) const {
  const Eigen::Vector3f low = corner.cast<float>() - origin_;
  const Eigen::Vector3f high = low + Eigen::Vector3f::Constant(static_cast<float>(edge));
  return anyBin(low, high, [&](std::size_t bin, float near_depth) { return farthest_[bin] >= near_depth; });
}

}  // namespace donex
