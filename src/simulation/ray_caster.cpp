#include "simulation/ray_caster.h"

#include <algorithm>
#include <cmath>

#include "core/pi.h"

namespace donex::simulation {
namespace {

constexpr auto kHalfTurn = static_cast<float>(kPi);  // [rad]
constexpr int kSectorColumns = 8;
constexpr int kUnevenColumns = 2400;     // where the columns themselves are not even
constexpr float kRoundingAngle = 2e-4f;  // [rad]
constexpr float kRounding = 1e-3f;       // [m]

int floorDivide(int a, int b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

/// Half edges of a box around the shape, in the shape's axes.
Eigen::Vector3f boundOf(const Shape& shape) {
  switch (shape.kind) {
    case ShapeKind::kCylinder: return {shape.half.x(), shape.half.x(), shape.half.z()};
    case ShapeKind::kSlats: return {shape.half.x(), 0.0f, shape.half.z()};
    default: return shape.half;
  }
}

}  // namespace

RayCaster::RayCaster(const SensorModel& model)
    : model_(model), sectors_(static_cast<std::size_t>(floorDivide(columnsAround() - 1, kSectorColumns)) + 1) {}

/// Directions, evenly around the sensor, by which targets are kept.
int RayCaster::columnsAround() const { return model_.is_even_turn ? model_.columns() : kUnevenColumns; }

int RayCaster::sectorOf(int column) const {
  if (model_.is_even_turn) return floorDivide(column, kSectorColumns);
  const Eigen::Vector2d heading = model_.headings[static_cast<std::size_t>(column)];
  const double from_rear = (kPi - std::atan2(heading.y(), heading.x())) / (2.0 * kPi);
  return std::clamp(static_cast<int>(from_rear * kUnevenColumns), 0, kUnevenColumns - 1) / kSectorColumns;
}

/// Those that the columns of a stretch lie in.
RayCaster::Open RayCaster::openSectors(const Stretch& stretch) const {
  if (!model_.is_even_turn) return {0, static_cast<int>(sectors_.size()) - 1};
  return {sectorOf(stretch.first_column), sectorOf(stretch.end_column - 1)};
}

RayCaster::Extent RayCaster::extentOf(const Target& target, const Stretch& stretch) {
  const Shape& shape = target.shape;
  const Eigen::Matrix3f sensor_axes = stretch.sensor.linear();
  const Eigen::Vector3f place = shape.center + target.velocity * (stretch.time - target.time);
  const Eigen::Vector3f center = sensor_axes.transpose() * (place - stretch.sensor.translation());
  const float margin = kRounding + stretch.movement + target.velocity.norm() * stretch.half_duration;
  const Eigen::Vector3f half = boundOf(shape) + Eigen::Vector3f::Constant(margin);
  const Eigen::Matrix3f edges = sensor_axes.transpose() * shape.axes * half.asDiagonal();

  // The box in the upright plane axes (towards its middle, across, up): its half edges there.
  const float distance = center.head<2>().norm();
  const Eigen::Vector2f towards =
      distance > 0.0f ? Eigen::Vector2f(center.head<2>() / distance) : Eigen::Vector2f::UnitX();
  float near = kMiss;
  float far = 0.0f;
  float low_side = kMiss;
  float high_side = -kMiss;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3f signs(corner & 1 ? 1.0f : -1.0f, corner & 2 ? 1.0f : -1.0f, corner & 4 ? 1.0f : -1.0f);
    const Eigen::Vector2f at = (center + edges * signs).head<2>();
    const float depth = at.dot(towards);
    const float side = (towards.x() * at.y() - towards.y() * at.x()) / std::max(depth, 1e-6f);
    near = std::min(near, depth);
    far = std::max(far, at.norm());
    low_side = std::min(low_side, side);
    high_side = std::max(high_side, side);
  }
  const float rise = edges.row(2).cwiseAbs().sum();
  Extent extent{std::max(near, 0.0f), -kMiss, kMiss, kNoTarget, 0.0f, kHalfTurn};
  if (near < 0.05f) return extent;  // around the sensor: it may be seen in any direction

  const float low = center.z() - rise;
  const float high = center.z() + rise;
  const float slope_low = low < 0.0f ? low / near : low / far;
  const float slope_high = high > 0.0f ? high / near : high / far;
  extent.slope_low = slope_low - (1.0f + slope_low * slope_low) * (stretch.rotation + kRoundingAngle);
  extent.slope_high = slope_high + (1.0f + slope_high * slope_high) * (stretch.rotation + kRoundingAngle);
  const float low_angle = std::atan(low_side);
  const float high_angle = std::atan(high_side);
  extent.azimuth = std::atan2(towards.y(), towards.x()) + 0.5f * (low_angle + high_angle);
  extent.half_angle = 0.5f * (high_angle - low_angle) + 1.5f * stretch.rotation + kRoundingAngle;
  return extent;
}

void RayCaster::distribute(const Extent& extent, const Stretch& stretch) {
  const int count = static_cast<int>(sectors_.size());
  const Open open = openSectors(stretch);
  const float columns_per_radian = static_cast<float>(columnsAround()) / (2.0f * kHalfTurn);
  const auto column_at = [&](float azimuth) { return (kHalfTurn - azimuth) * columns_per_radian - 0.5f; };
  const auto first_column = static_cast<int>(std::floor(column_at(extent.azimuth + extent.half_angle)));
  const auto last_column = static_cast<int>(std::ceil(column_at(extent.azimuth - extent.half_angle)));
  int first = floorDivide(first_column, kSectorColumns);
  int last = floorDivide(last_column, kSectorColumns);
  if (last - first >= count) {
    first = 0;
    last = count - 1;
  }
  for (int sector = first; sector <= last; ++sector) {
    const int wrapped = sector - count * floorDivide(sector, count);
    if (wrapped >= open.first && wrapped <= open.last) sectors_[static_cast<std::size_t>(wrapped)].push_back(extent);
  }
}

void RayCaster::prepare(const std::vector<Target>& targets, const Stretch& stretch) {
  targets_ = &targets;
  extents_.clear();
  for (std::size_t i = 0; i < targets.size(); ++i) {
    extents_.push_back(extentOf(targets[i], stretch));
    extents_.back().target = static_cast<int>(i);
  }
  std::sort(extents_.begin(), extents_.end(),
            [](const Extent& a, const Extent& b) { return a.near != b.near ? a.near < b.near : a.target < b.target; });
  const Open open = openSectors(stretch);
  for (int s = open.first; s <= open.last; ++s) sectors_[static_cast<std::size_t>(s)].clear();
  for (const Extent& extent : extents_) distribute(extent, stretch);
}

void RayCaster::cast(int column, const Eigen::Isometry3f& sensor, float time, std::vector<Hit>& hits) const {
  const Eigen::Vector2f heading = model_.headings[static_cast<std::size_t>(column)].cast<float>();
  const Eigen::Matrix3f axes = sensor.linear();
  const Eigen::Vector3f forward = axes.leftCols<2>() * heading;
  const Eigen::Vector3f up = axes.col(2);
  const std::vector<Extent>& sector = sectors_[static_cast<std::size_t>(sectorOf(column))];
  const Slopes slopes = model_.slopesOf(column);
  for (std::size_t beam = 0; beam < slopes.size(); ++beam) {
    const float slope = slopes[beam];
    Ray ray{sensor.translation(), forward + slope * up};
    Hit& hit = hits[beam];
    for (const Extent& extent : sector) {
      if (extent.near > hit.parameter) break;
      if (slope < extent.slope_low || slope > extent.slope_high) continue;
      const Target& target = (*targets_)[static_cast<std::size_t>(extent.target)];
      ray.origin = sensor.translation() - target.velocity * (time - target.time);
      const float parameter = intersect(target.shape, ray, hit.parameter);
      if (parameter < hit.parameter) hit = {parameter, extent.target};
    }
  }
}

}  // namespace donex::simulation
