#include "core/sight/range_image.h"

#include <algorithm>
#include <cmath>

#include "core/pi.h"

namespace donex {
namespace {}  // namespace

RangeImage::RangeImage(const Resolution& resolution)
    : columns_(static_cast<int>(std::lround(360.0 / resolution.column))),
      rows_(static_cast<int>(std::ceil(2.0 * kSteepestElevation / resolution.row))),
      columns_a_radian_(static_cast<float>(columns_ / (2.0 * kPi))),
      rows_a_radian_(static_cast<float>(1.0 / (resolution.row * kRadiansPerDegree))),
      ranges_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0.0F) {}

void RangeImage::clear() {
  for (const int pixel : used_) ranges_[static_cast<std::size_t>(pixel)] = 0.0F;
  used_.clear();
}

int RangeImage::pixelOf(const Eigen::Vector3f& point) const {
  const float across = point.head<2>().norm();
  const bool is_direction = std::isfinite(across) && std::isfinite(point.z()) && across > 0.0F;
  if (!is_direction) return kNone;
  const float elevation = std::atan2(point.z(), across) + static_cast<float>(kSteepestElevation * kRadiansPerDegree);
  const int row = static_cast<int>(std::floor(elevation * rows_a_radian_));
  if (row < 0 || row >= rows_) return kNone;
  const float azimuth = std::atan2(point.y(), point.x()) + static_cast<float>(kPi);
  const int column = std::min(static_cast<int>(azimuth * columns_a_radian_), columns_ - 1);
  return row * columns_ + std::max(column, 0);
}

void RangeImage::add(const Eigen::Vector3f& point) {
  const int pixel = pixelOf(point);
  if (pixel == kNone) return;
  float& range = ranges_[static_cast<std::size_t>(pixel)];
  const float own = point.norm();
  if (range == 0.0F) used_.push_back(pixel);
  if (range == 0.0F || own < range) range = own;
}

float RangeImage::rangeTowards(const Eigen::Vector3f& point) const {
  const int pixel = pixelOf(point);
  return pixel == kNone ? 0.0F : ranges_[static_cast<std::size_t>(pixel)];
}

}  // namespace donex
