#include "core/methods/point_shadows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/Eigenvalues>

#include "core/pi.h"

namespace donex {
namespace {

constexpr int kShadowColumns = 360, kShadowRows = 180;  // bins of one degree
constexpr double kBin = kRadiansPerDegree;
constexpr float kUnset = std::numeric_limits<float>::infinity();

int rowOf(double elevation) {
  return std::clamp(static_cast<int>(std::floor((elevation + kPi / 2) / kBin)), 0, kShadowRows - 1);
}
int columnOf(double azimuth) {
  return std::clamp(static_cast<int>(std::floor((azimuth + kPi) / kBin)), 0, kShadowColumns - 1);
}
std::uint32_t binOf(int row, int column) { return static_cast<std::uint32_t>(row * kShadowColumns + column); }
double elevationOf(const Eigen::Vector3d& direction) { return std::asin(std::clamp(direction.z(), -1.0, 1.0)); }
double azimuthOf(const Eigen::Vector3d& direction) { return std::atan2(direction.y(), direction.x()); }

/// How many columns to each side hold all directions within `angle`; all of them where a pole is near.
int columnsAround(double elevation, double angle) {
  const double room = kPi / 2 - std::abs(elevation);
  if (angle >= room - kBin) return kShadowColumns / 2;
  const double widest = std::asin(std::sin(angle) / std::cos(elevation));
  return std::min(static_cast<int>(std::ceil(widest / kBin)) + 1, kShadowColumns / 2);
}

}  // namespace

double PointShadows::angleAt(double range, double diagonal) {
  const double sine = diagonal / (range - diagonal);
  return range <= diagonal || sine >= 1.0 ? kPi : 2.0 * std::asin(sine);
}

void PointShadows::sortByDirection(const std::vector<Eigen::Vector3f>& echoes,
                                   const std::vector<std::uint8_t>& is_echo) {
  const std::size_t count = echoes.size();
  directions_.assign(count, Eigen::Vector3d::Zero());
  ranges_.assign(count, 0.0);
  bin_of_.assign(count, 0);
  first_.assign(kShadowColumns * kShadowRows + 1, 0);
  by_range_.clear();
  for (std::uint32_t i = 0; i < count; ++i) {
    if (is_echo[i] == 0) continue;
    ranges_[i] = echoes[i].cast<double>().norm();
    directions_[i] = echoes[i].cast<double>() / ranges_[i];
    bin_of_[i] = binOf(rowOf(elevationOf(directions_[i])), columnOf(azimuthOf(directions_[i])));
    ++first_[bin_of_[i]];
    by_range_.push_back(i);
  }
  // Counts become ends; filling backwards turns the ends into starts.
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  sorted_.resize(by_range_.size());
  for (std::size_t k = by_range_.size(); k-- > 0;) sorted_[--first_[bin_of_[by_range_[k]]]] = by_range_[k];
  std::stable_sort(by_range_.begin(), by_range_.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return ranges_[a] < ranges_[b]; });
}

void PointShadows::search(std::uint32_t echo, double angle) {
  found_.clear();
  const Eigen::Vector3d& center = directions_[echo];
  const double elevation = elevationOf(center), least_cosine = std::cos(angle);
  const int column = columnOf(azimuthOf(center)), around = columnsAround(elevation, angle);
  const int last = std::min(around, kShadowColumns / 2 - 1);  // no column twice
  for (int row = rowOf(elevation - angle - kBin); row <= rowOf(elevation + angle + kBin); ++row) {
    for (int step = -around; step <= last; ++step) {
      const std::uint32_t bin = binOf(row, (column + step + kShadowColumns) % kShadowColumns);
      for (std::uint32_t at = first_[bin]; at < first_[bin + 1]; ++at) {
        if (directions_[sorted_[at]].dot(center) >= least_cosine) found_.push_back(sorted_[at]);
      }
    }
  }
  std::sort(found_.begin(), found_.end());
}

/// Of the plane through the found echoes, towards the sensor; fewer than three make no plane: straight at it.
Eigen::Vector3d PointShadows::normalOf(const std::vector<Eigen::Vector3f>& echoes, std::uint32_t echo) const {
  if (found_.size() < 3) return -directions_[echo];
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const std::uint32_t i : found_) mean += echoes[i].cast<double>();
  mean /= static_cast<double>(found_.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const std::uint32_t i : found_) {
    const Eigen::Vector3d off = echoes[i].cast<double>() - mean;
    scatter += off * off.transpose();
  }
  const Eigen::Vector3d normal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors().col(0);
  return normal.dot(directions_[echo]) >= 0.0 ? Eigen::Vector3d(-normal) : normal;
}

void PointShadows::shade(const std::vector<Eigen::Vector3f>& echoes, std::uint32_t echo,
                         const Eigen::Vector3d& normal) {
  const double distance = (echoes[echo].cast<double>() + normal * static_cast<double>(diagonal_ + fuzz_)).dot(normal);
  const auto reach = [&](std::uint32_t i) { return std::max(distance / directions_[i].dot(normal), 0.0); };
  most_[echo] = directions_[echo].dot(normal) == 0.0 ? 0.0F : static_cast<float>(reach(echo));
  for (const std::uint32_t i : found_) {
    const bool meets = directions_[i].dot(normal) != 0.0;
    const bool is_behind = meets && distance / directions_[i].dot(normal) <= ranges_[i];
    if (is_behind) most_[i] = std::min(most_[i], static_cast<float>(reach(i)));
  }
}

const std::vector<float>& PointShadows::cast(const std::vector<Eigen::Vector3f>& echoes,
                                             const std::vector<std::uint8_t>& is_echo) {
  sortByDirection(echoes, is_echo);
  most_.assign(echoes.size(), kUnset);
  for (const std::uint32_t echo : by_range_) {
    if (most_[echo] != kUnset) continue;
    search(echo, angleAt(ranges_[echo], static_cast<double>(diagonal_)));
    shade(echoes, echo, normalOf(echoes, echo));
  }
  for (std::size_t i = 0; i < most_.size(); ++i) {
    if (is_echo[i] == 0) most_[i] = 0.0F;
  }
  return most_;
}

std::size_t PointShadows::memoryBytes() const {
  return directions_.capacity() * sizeof(Eigen::Vector3d) + ranges_.capacity() * sizeof(double) +
         (first_.capacity() + sorted_.capacity() + bin_of_.capacity() + by_range_.capacity() + found_.capacity()) *
             sizeof(std::uint32_t) +
         most_.capacity() * sizeof(float);
}

}  // namespace donex
