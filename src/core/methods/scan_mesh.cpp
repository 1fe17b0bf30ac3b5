#include "core/methods/scan_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Geometry>

#include "core/pi.h"

namespace donex {
namespace {

constexpr int kMeshColumns = 1800;     // 0.2 degrees: about what a sensor at 10 Hz has between two shots
constexpr int kFarthestColumn = 3;     // a column without neighbours may be this many columns away
constexpr float kLeastCosine = 0.03F;  // flatter than any ground in reach: a triangle across a step in depth
constexpr float kRoom = 0.02F;         // by which the meeting point may leave the triangle's own ranges [share]

float azimuthOf(const Eigen::Vector3f& p) { return std::atan2(p.y(), p.x()); }
float elevationOf(const Eigen::Vector3f& p) { return std::atan2(p.z(), p.head<2>().norm()); }

float columnsOf(float azimuth) { return (azimuth + kPiF) * (kMeshColumns / (2.0F * kPiF)); }
int wrapped(int column) { return (column % kMeshColumns + kMeshColumns) % kMeshColumns; }

/// From one angle to another, in (-pi, pi].
float turnTo(float to, float from) {
  const float turn = to - from;
  if (turn > kPiF) return turn - 2.0F * kPiF;
  return turn <= -kPiF ? turn + 2.0F * kPiF : turn;
}

/// Where the direction meets the plane of the three corners.
ScanMesh::Surface meet(const Eigen::Vector3f& direction, const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                       const Eigen::Vector3f& c) {
  const Eigen::Vector3f ranges(a.norm(), b.norm(), c.norm());
  ScanMesh::Surface surface;
  const Eigen::Vector3f normal = (b - a).cross(c - a).normalized();
  const float along = normal.dot(direction.normalized());
  surface.cosine = std::abs(along);
  surface.range = normal.dot(a) / along;
  surface.far_range = ranges.maxCoeff();
  const bool is_inside = surface.range >= ranges.minCoeff() * (1.0F - kRoom) &&
                         surface.range <= ranges.maxCoeff() * (1.0F + kRoom);  // false for NaN
  surface.is_edge = !is_inside || !(surface.cosine >= kLeastCosine);
  if (surface.is_edge) surface.range = ranges.minCoeff();
  return surface;
}

}  // namespace

void ScanMesh::build(const std::vector<Eigen::Vector3f>& echoes) {
  first_.assign(kMeshColumns + 1, 0);
  column_of_.assign(echoes.size(), -1);
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    const bool is_echo = echoes[i].allFinite() && echoes[i].head<2>().squaredNorm() > 0.0F;
    if (!is_echo) continue;
    column_of_[i] = wrapped(static_cast<int>(columnsOf(azimuthOf(echoes[i]))));
    ++first_[static_cast<std::size_t>(column_of_[i])];
  }
  // Counts become ends; filling backwards turns the ends into starts.
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  corners_.resize(first_.back());
  for (std::size_t i = echoes.size(); i-- > 0;) {
    if (column_of_[i] < 0) continue;
    Corner& corner = corners_[--first_[static_cast<std::size_t>(column_of_[i])]];
    corner = {elevationOf(echoes[i]), azimuthOf(echoes[i]), echoes[i]};
  }
  const auto lower = [](const Corner& a, const Corner& b) { return a.elevation < b.elevation; };
  for (std::size_t column = 0; column < kMeshColumns; ++column) {
    std::stable_sort(corners_.begin() + static_cast<std::ptrdiff_t>(first_[column]),
                     corners_.begin() + static_cast<std::ptrdiff_t>(first_[column + 1]), lower);
  }
}

std::optional<ScanMesh::Side> ScanMesh::bracket(int column, float elevation) const {
  const auto index = static_cast<std::size_t>(wrapped(column));
  const auto begin = corners_.begin() + static_cast<std::ptrdiff_t>(first_[index]);
  const auto end = corners_.begin() + static_cast<std::ptrdiff_t>(first_[index + 1]);
  const auto above = std::upper_bound(begin, end, elevation,
                                      [](float value, const Corner& corner) { return value < corner.elevation; });
  const bool is_between = above != begin && above != end;
  if (!is_between || above->elevation - std::prev(above)->elevation > largest_gap_) return std::nullopt;
  return Side{&*std::prev(above), &*above};
}

std::optional<ScanMesh::Side> ScanMesh::search(int column, int step, float elevation) const {
  for (int i = 0; i < kFarthestColumn; ++i) {
    if (const auto side = bracket(column + i * step, elevation)) return side;
  }
  return std::nullopt;
}

std::optional<ScanMesh::Surface> ScanMesh::at(const Eigen::Vector3f& direction) const {
  if (corners_.empty()) return std::nullopt;
  const float azimuth = azimuthOf(direction), elevation = elevationOf(direction);
  const int left = static_cast<int>(std::floor(columnsOf(azimuth) - 0.5F));
  const auto from = search(left, -1, elevation);
  const auto to = search(left + 1, 1, elevation);
  if (!from || !to) return std::nullopt;
  // The quadrangle's diagonal goes from below on one side to above on the other.
  const float width = turnTo(to->below->azimuth, from->below->azimuth);
  const float across = width > 0.0F ? turnTo(azimuth, from->below->azimuth) / width : 0.0F;
  const float up =
      (elevation - from->below->elevation) / std::max(from->above->elevation - from->below->elevation, 1e-6F);
  const Corner* third = up <= across ? to->below : from->above;
  return meet(direction, from->below->point, to->above->point, third->point);
}

std::size_t ScanMesh::memoryBytes() const {
  return first_.capacity() * sizeof(std::size_t) + corners_.capacity() * sizeof(Corner) +
         column_of_.capacity() * sizeof(int);
}

}  // namespace donex
