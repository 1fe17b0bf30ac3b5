#include "core/grid/echo_block.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/grid/grid_window.h"
#include "core/grid/simd.h"

namespace donex {
namespace {

/// An affine map, one output coordinate. The order of the sums is Eigen's.
struct Row {
  float a, b, c, d;
  float operator()(float x, float y, float z) const { return (a * x + (b * y + c * z)) + d; }
};

Row rowOf(const Eigen::Matrix3f& matrix, const Eigen::Vector3f& offset, int row) {
  return {matrix(row, 0), matrix(row, 1), matrix(row, 2), offset[row]};
}

DONEX_WIDE_LOOPS void placeAll(const Placement& p, const float* echoes, EchoBlock& block) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  const Row to_x = rowOf(p.rotation, p.origin, 0), to_y = rowOf(p.rotation, p.origin, 1);
  const Row to_z = rowOf(p.rotation, p.origin, 2);
  const Row base_x = rowOf(p.mounting, p.mounted_at, 0), base_y = rowOf(p.mounting, p.mounted_at, 1);
  const Row base_z = rowOf(p.mounting, p.mounted_at, 2);
  const float low_x = p.region_low.x(), low_y = p.region_low.y(), low_z = p.region_low.z();
  const float high_x = p.region_high.x(), high_y = p.region_high.y(), high_z = p.region_high.z();
  const float extent_x = p.extent.x(), extent_y = p.extent.y(), extent_z = p.extent.z();
  int found = 0;
  constexpr std::ptrdiff_t kNext = 3;  // floats
  for (int i = 0; i < EchoBlock::kSize; ++i) {
    const float x = echoes[kNext * i], y = echoes[kNext * i + 1], z = echoes[kNext * i + 2];
    const bool is_echo = x * x + (y * y + z * z) <= kFarthestEcho * kFarthestEcho;  // false for NaN
    const float bx = base_x(x, y, z), by = base_y(x, y, z), bz = base_z(x, y, z);
    const float ux = to_x(x, y, z), uy = to_y(x, y, z), uz = to_z(x, y, z);
    const bool in_region = static_cast<int>(bx >= low_x) & static_cast<int>(bx < high_x) &
                           static_cast<int>(by >= low_y) & static_cast<int>(by < high_y) &
                           static_cast<int>(bz >= low_z) & static_cast<int>(bz < high_z);
    const bool in_window = static_cast<int>(ux >= 0.0F) & static_cast<int>(ux < extent_x) &
                           static_cast<int>(uy >= 0.0F) & static_cast<int>(uy < extent_y) &
                           static_cast<int>(uz >= 0.0F) & static_cast<int>(uz < extent_z);
    found += static_cast<int>(is_echo);
    block.x[i] = is_echo ? ux : kNone;
    block.y[i] = is_echo ? uy : kNone;
    block.z[i] = is_echo ? uz : kNone;
    const bool inside = static_cast<int>(is_echo) & static_cast<int>(in_region) & static_cast<int>(in_window);
    block.inside[i] = inside;
    // Not negative: truncation is floor.
    block.voxel_x[i] = static_cast<int>(inside ? ux : 0.0F);
    block.voxel_y[i] = static_cast<int>(inside ? uy : 0.0F);
    block.voxel_z[i] = static_cast<int>(inside ? uz : 0.0F);
  }
  for (int i = 0; i < EchoBlock::kSize; ++i) block.observed[i] = static_cast<std::uint8_t>(block.inside[i]);
  block.none = block.count - found;
}

}  // namespace

Eigen::Vector3f Placement::toWindow(const Eigen::Vector3f& echo) const {
  Eigen::Vector3f in_window;
  for (int axis = 0; axis < 3; ++axis) in_window[axis] = rowOf(rotation, origin, axis)(echo.x(), echo.y(), echo.z());
  return in_window;
}

void EchoBlock::appendNoEchoes(std::size_t first, std::vector<std::uint32_t>& numbers) const {
  if (none == 0) return;
  for (int i = 0; i < count; ++i) {
    if (std::isnan(x[i])) numbers.push_back(static_cast<std::uint32_t>(first) + static_cast<std::uint32_t>(i));
  }
}

void EchoBlock::place(const Placement& placement, const Eigen::Vector3f* echoes, int echoes_count) {
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
  count = echoes_count;
  if (count == kSize) return placeAll(placement, echoes->data(), *this);
  alignas(64) std::array<float, 3 * std::size_t{kSize}> padded;
  std::fill(std::copy_n(echoes->data(), 3 * count, padded.begin()), padded.end(),
            std::numeric_limits<float>::quiet_NaN());
  placeAll(placement, padded.data(), *this);
}

}  // namespace donex
