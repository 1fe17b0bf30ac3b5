#include "core/sight/sight_pixels.h"

#include <algorithm>

#include "core/grid/simd.h"

namespace donex {
namespace {

DONEX_WIDE_LOOPS void projectAll(const Eigen::Vector3f* echoes, const std::uint8_t* is_echo, std::size_t count,
                                 std::int32_t* columns, std::int32_t* rows, float* ranges) {
  const auto* xyz = reinterpret_cast<const float*>(echoes);
  for (std::size_t i = 0; i < count; ++i) {
    const SightPixels::Pixel pixel = SightPixels::of(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]);
    const int valid = static_cast<int>(pixel.valid) & static_cast<int>(is_echo[i] != 0);
    columns[i] = pixel.column;
    rows[i] = pixel.row | (valid - 1);  // -1 where it is not valid
    ranges[i] = std::min(std::max(pixel.range / SightPixels::kRangeStep, 1.0F), 65535.0F);
  }
}

DONEX_WIDE_LOOPS SightPixels::Span spanOf(const std::int32_t* rows, std::size_t count) {
  int lowest = SightPixels::kRows, highest = -1;
  for (std::size_t i = 0; i < count; ++i) {
    lowest = std::min(lowest, rows[i] < 0 ? SightPixels::kRows : rows[i]);
    highest = std::max(highest, rows[i]);
  }
  return {lowest, highest};
}

}  // namespace

SightPixels::Span SightPixels::span() const { return spanOf(rows_.data(), rows_.size()); }

void SightPixels::project(const std::vector<Eigen::Vector3f>& echoes, const std::vector<std::uint8_t>& is_echo,
                          const Workers& workers) {
  resize(echoes.size());
  forEachStretch(workers, echoes.size(), [&](std::size_t first, std::size_t last) {
    projectAll(echoes.data() + first, is_echo.data() + first, last - first, columns_.data() + first,
               rows_.data() + first, ranges_.data() + first);
  });
}

void SightPixels::project(const std::vector<Eigen::Vector3f>& echoes, const std::vector<std::uint8_t>& is_echo,
                          const Eigen::Isometry3f& frame_from_echoes) {
  resizeTo(moved_, echoes.size());
  std::transform(echoes.begin(), echoes.end(), moved_.begin(),
                 [&](const Eigen::Vector3f& echo) -> Eigen::Vector3f { return frame_from_echoes * echo; });
  project(moved_, is_echo);
}

}  // namespace donex
