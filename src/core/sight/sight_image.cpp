#include "core/sight/sight_image.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/grid/simd.h"
#include "core/pi.h"

namespace donex {
namespace {

constexpr int kColumns = 1024;        // a power of two: azimuth wraps by masking
constexpr float kRowHeight = 0.006F;  // tangent of the elevation
constexpr float kSteepest = 1.2F;     // tangent beyond which nothing is asked
constexpr float kRangeStep = 0.02F;   // [m]
constexpr float kNearest = 0.3F;      // [m] nothing is asked nearer to the sensor's axis
constexpr float kFarthest = 1e6F;     // [m] nor farther away: infinity has no azimuth
/// Of an image that covers everything.
constexpr auto kPixels =
    static_cast<std::size_t>(kColumns) * static_cast<std::size_t>(2.0F * kSteepest / kRowHeight + 1.0F);

/// atan2 to 1e-4 rad, the same on every machine; monotone within an octant, which is all a column needs.
inline float azimuthOf(float y, float x) {
  const float ax = std::abs(x), ay = std::abs(y);
  const float a = std::min(ax, ay) / std::max(ax, ay);
  const float s = a * a;
  float angle = ((-0.0464964749F * s + 0.15931422F) * s - 0.327622764F) * s * a + a;
  angle = ay > ax ? 0.5F * kPiF - angle : angle;
  angle = x < 0.0F ? kPiF - angle : angle;
  return y < 0.0F ? -angle : angle;
}

struct Projected {
  bool valid;
  int column, row;
  float range;
};

/// Column and row are 0 where the point is not valid: nothing is asked so near to the sensor's axis, so far from it, or
/// so steeply.
inline Projected project(float x, float y, float z) {
  const float horizontal = std::sqrt(x * x + y * y);
  const float slope = z / horizontal;
  const bool valid = static_cast<int>(horizontal > kNearest) & static_cast<int>(horizontal < kFarthest) &
                     static_cast<int>(std::abs(slope) < kSteepest);
  const float turn = (azimuthOf(y, x) + kPiF) * (kColumns / (2.0F * kPiF));
  const float row = (slope + kSteepest) / kRowHeight;
  return {valid, static_cast<int>(valid ? turn : 0.0F) & (kColumns - 1), static_cast<int>(valid ? row : 0.0F),
          std::sqrt(horizontal * horizontal + z * z)};
}

/// Number of a pixel in an image of so many rows.
inline std::size_t pixelOf(int column, int row, int rows) {
  return static_cast<std::size_t>(column) * static_cast<std::size_t>(rows) + static_cast<std::size_t>(row);
}

DONEX_WIDE_LOOPS void projectAll(const Eigen::Vector3f* echoes, const std::uint8_t* is_echo, std::size_t count,
                                 std::int32_t* columns, std::int32_t* rows, float* ranges) {
  const auto* xyz = reinterpret_cast<const float*>(echoes);
  for (std::size_t i = 0; i < count; ++i) {
    const Projected pixel = project(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]);
    const bool valid = static_cast<int>(pixel.valid) & static_cast<int>(is_echo[i] != 0);
    columns[i] = pixel.column;
    rows[i] = valid ? pixel.row : -1;
    ranges[i] = std::min(std::max(pixel.range / kRangeStep, 1.0F), 65535.0F);
  }
}

}  // namespace

void SightImage::build(const std::vector<Eigen::Vector3f>& echoes, const std::vector<std::uint8_t>& is_echo,
                       const Reading& reading) {
  collect(echoes, is_echo);
  hit_.reserve(kPixels);
  hit_ = nearest_;
  if (!reading.careful) return;
  fillBetweenBeams(static_cast<int>(reading.largest_gap / static_cast<double>(kRowHeight)));
  fillBetweenColumns();
  erode();
}

void SightImage::collect(const std::vector<Eigen::Vector3f>& echoes, const std::vector<std::uint8_t>& is_echo) {
  const std::size_t count = echoes.size();
  pixels_.resize(count);
  projectAll(echoes.data(), is_echo.data(), count, pixels_.columns.data(), pixels_.rows.data(), pixels_.ranges.data());
  int lowest = std::numeric_limits<int>::max(), highest = -1;
  for (const std::int32_t row : pixels_.rows) {
    lowest = std::min(lowest, row < 0 ? lowest : row);
    highest = std::max(highest, row);
  }
  first_row_ = highest < 0 ? 0 : lowest;
  rows_ = highest < 0 ? 0 : highest - lowest + 1;
  nearest_.reserve(kPixels);
  nearest_.assign(pixelOf(kColumns, 0, rows_), 0);
  for (std::size_t i = 0; i < count; ++i) {
    if (pixels_.rows[i] < 0) continue;
    const auto range = static_cast<Range>(pixels_.ranges[i]);
    Range& nearest = nearest_[pixelOf(pixels_.columns[i], pixels_.rows[i] - first_row_, rows_)];
    if (nearest == 0 || range < nearest) nearest = range;
  }
}

void SightImage::fillBetweenBeams(int largest_gap) {
  for (int c = 0; c < kColumns; ++c) {
    Range* column = nearest_.data() + static_cast<std::ptrdiff_t>(c) * rows_;
    int last = -1;
    for (int row = 0; row < rows_; ++row) {
      if (column[row] == 0) continue;
      const bool neighbours = last >= 0 && row - last <= largest_gap;
      if (neighbours) std::fill(column + last + 1, column + row, std::min(column[last], column[row]));
      last = row;
    }
  }
}

void SightImage::fillBetweenColumns() {
  // Only single columns: a sensor whose azimuth steps are a little wider than ours.
  scratch_.reserve(kPixels);
  scratch_ = nearest_;
  for (int c = 0; c < kColumns; ++c) {
    const Range* left = scratch_.data() + static_cast<std::ptrdiff_t>((c - 1) & (kColumns - 1)) * rows_;
    const Range* right = scratch_.data() + static_cast<std::ptrdiff_t>((c + 1) & (kColumns - 1)) * rows_;
    Range* column = nearest_.data() + static_cast<std::ptrdiff_t>(c) * rows_;
    for (int row = 0; row < rows_; ++row) {
      const bool between = column[row] == 0 && left[row] != 0 && right[row] != 0;
      if (between) column[row] = std::min(left[row], right[row]);
    }
  }
}

void SightImage::erode() {
  // Unknown pixels around say nothing: as unsigned, 0 - 1 is the largest range, so min passes them by.
  const auto nearer = [](Range a, Range b) {
    return static_cast<Range>(std::min<Range>(static_cast<Range>(a - 1), static_cast<Range>(b - 1)) + 1);
  };
  scratch_.resize(nearest_.size());
  for (int c = 0; c < kColumns; ++c) {
    const Range* column = nearest_.data() + static_cast<std::ptrdiff_t>(c) * rows_;
    Range* result = scratch_.data() + static_cast<std::ptrdiff_t>(c) * rows_;
    for (int row = 0; row < rows_; ++row) {
      const Range below = row > 0 ? column[row - 1] : Range{0}, above = row + 1 < rows_ ? column[row + 1] : Range{0};
      result[row] = nearer(column[row], nearer(below, above));
    }
  }
  for (int c = 0; c < kColumns; ++c) {
    const Range* left = scratch_.data() + static_cast<std::ptrdiff_t>((c - 1) & (kColumns - 1)) * rows_;
    const Range* right = scratch_.data() + static_cast<std::ptrdiff_t>((c + 1) & (kColumns - 1)) * rows_;
    const Range* middle = scratch_.data() + static_cast<std::ptrdiff_t>(c) * rows_;
    Range* column = nearest_.data() + static_cast<std::ptrdiff_t>(c) * rows_;
    for (int row = 0; row < rows_; ++row) {
      if (column[row] != 0) column[row] = nearer(middle[row], nearer(left[row], right[row]));
    }
  }
}

SightImage::Sight SightImage::at(const Eigen::Vector3f& point, float margin) const {
  return read(nearest_, point, margin);
}

SightImage::Sight SightImage::throughGaps(const Eigen::Vector3f& point, float margin) const {
  return read(hit_, point, margin);
}

SightImage::Sight SightImage::read(const std::vector<Range>& image, const Eigen::Vector3f& point, float margin) const {
  const Projected pixel = project(point.x(), point.y(), point.z());
  if (!pixel.valid) return Sight::kUnknown;
  const int row = pixel.row - first_row_;
  if (row < 0 || row >= rows_ || image.empty()) return Sight::kUnknown;
  const Range nearest = image[pixelOf(pixel.column, row, rows_)];
  if (nearest == 0) return Sight::kUnknown;
  const float beyond = static_cast<float>(nearest) * kRangeStep - pixel.range;
  if (beyond > margin) return Sight::kFree;
  return beyond > -margin ? Sight::kSurface : Sight::kHidden;
}

double SightImage::workspaceBytes(double echoes) { return 2.0 * answerBytes() + roomFor(3.0 * sizeof(float) * echoes); }

double SightImage::answerBytes() { return static_cast<double>(kPixels * sizeof(Range)); }

std::size_t SightImage::memoryBytes() const {
  return (nearest_.capacity() + hit_.capacity() + scratch_.capacity()) * sizeof(Range) + pixels_.bytes();
}

}  // namespace donex
