#include "core/sight/sight_image.h"

#include <algorithm>

namespace donex {
namespace {

constexpr int kColumns = SightPixels::kColumns;
/// Of an image that covers everything.
constexpr auto kPixels = static_cast<std::size_t>(kColumns) * static_cast<std::size_t>(SightPixels::kRows);
constexpr int kMoreRows = 8;   // when parts of a turn reach beyond those before, they may do so again
constexpr int kAsCovered = 2;  // columns beside one that is covered: a sensor may step wider than ours

/// Unknown pixels say nothing: as unsigned, 0 - 1 is the largest range, so min passes them by.
inline std::uint16_t nearer(std::uint16_t a, std::uint16_t b) {
  const auto least = std::min<std::uint16_t>(static_cast<std::uint16_t>(a - 1), static_cast<std::uint16_t>(b - 1));
  return static_cast<std::uint16_t>(least + 1);
}

/// Those within `reach` of one that is set.
std::array<std::uint8_t, kColumns> around(const std::array<std::uint8_t, kColumns>& columns, int reach) {
  std::array<std::uint8_t, kColumns> result = columns;
  for (int step = 1; step <= reach; ++step) {
    for (std::size_t c = 0; c < kColumns; ++c) {
      const auto ahead = static_cast<std::size_t>(step);
      const bool is_beside = columns[(c + ahead) & (kColumns - 1)] != 0 || columns[(c - ahead) & (kColumns - 1)] != 0;
      if (is_beside) result[c] = 1;
    }
  }
  return result;
}

}  // namespace

void SightImage::clear() {
  rows_ = first_row_ = 0;
  nearest_.clear();
  hit_.clear();
  covered_ = {};
  beams_ = BeamSpacing();
}

void SightImage::add(const SightPixels& seen, const Reading& reading, Workspace& workspace) {
  if (!makeRoomFor(seen, workspace)) return;
  const Columns changed = collect(seen);
  const Columns beside = around(changed, kAsCovered);
  for (std::size_t c = 0; c < kColumns; ++c) covered_[c] = std::max(covered_[c], beside[c]);
  if (reading.careful) {
    readCarefully(changed, static_cast<int>(reading.largest_gap / static_cast<double>(SightPixels::kRowHeight)),
                  workspace);
    return;
  }
  for (int c = 0; c < kColumns; ++c) {
    if (changed[static_cast<std::size_t>(c)] != 0) {
      std::copy_n(hit_.begin() + startOf(c), rows_, nearest_.begin() + startOf(c));
    }
  }
}

/// False where nothing was seen.
bool SightImage::makeRoomFor(const SightPixels& seen, Workspace& workspace) {
  const auto [lowest, highest] = seen.span();
  if (highest < 0) return false;
  if (rows_ == 0) {
    first_row_ = lowest;
    rows_ = highest - lowest + 1;
    hit_.reserve(kPixels);
    nearest_.reserve(kPixels);
    hit_.assign(static_cast<std::size_t>(kColumns) * static_cast<std::size_t>(rows_), 0);
    nearest_.assign(hit_.size(), 0);
    return true;
  }
  const bool has_room = lowest >= first_row_ && highest < first_row_ + rows_;
  if (has_room) return true;
  const int last = std::min(std::max(highest + kMoreRows, first_row_ + rows_ - 1), SightPixels::kRows - 1);
  const int first = std::max(std::min(lowest - kMoreRows, first_row_), 0);
  layOut(hit_, first, last - first + 1, workspace.beams);
  layOut(nearest_, first, last - first + 1, workspace.beams);
  first_row_ = first;
  rows_ = last - first + 1;
  return true;
}

void SightImage::layOut(std::vector<Range>& image, int first_row, int rows, std::vector<Range>& scratch) const {
  scratch.reserve(kPixels);
  scratch.assign(image.begin(), image.end());
  image.assign(static_cast<std::size_t>(kColumns) * static_cast<std::size_t>(rows), 0);
  for (int c = 0; c < kColumns; ++c) {
    std::copy_n(scratch.begin() + startOf(c), rows_,
                image.begin() + static_cast<std::ptrdiff_t>(c) * rows + (first_row_ - first_row));
  }
}

/// The columns that were hit.
SightImage::Columns SightImage::collect(const SightPixels& seen) {
  Columns changed{};
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen.row(i) < 0) continue;
    const auto range = static_cast<Range>(seen.range(i));
    Range& nearest = hit_[static_cast<std::size_t>(startOf(seen.column(i)) + seen.row(i) - first_row_)];
    nearest = nearer(nearest, range);
    changed[static_cast<std::size_t>(seen.column(i))] = 1;
  }
  return changed;
}

/// What changes reaches a column farther with each of the last two steps; they need as much around again.
void SightImage::readCarefully(const Columns& changed, int largest_gap, Workspace& workspace) {
  for (std::vector<Range>* step : {&workspace.beams, &workspace.between, &workspace.upright}) {
    step->reserve(kPixels);
    step->resize(hit_.size());
  }
  const auto each = [](const Columns& columns, const auto& visit) {
    for (int c = 0; c < kColumns; ++c) {
      if (columns[static_cast<std::size_t>(c)] != 0) visit(c);
    }
  };
  const Columns to_change = around(changed, 2), to_erode = around(changed, 3);
  each(around(changed, 4), [&](int c) { fillBetweenBeams(c, largest_gap, workspace.beams); });
  each(to_erode, [&](int c) {
    fillBetweenColumns(c, workspace.beams, workspace.between);
    erodeUpright(c, workspace.between, workspace.upright);
  });
  each(to_change, [&](int c) { erodeAcross(c, workspace.between, workspace.upright); });
}

void SightImage::fillBetweenBeams(int column, int largest_gap, std::vector<Range>& beams) const {
  Range* filled = beams.data() + startOf(column);
  std::copy_n(hit_.data() + startOf(column), rows_, filled);
  int last = -1;
  for (int row = 0; row < rows_; ++row) {
    if (filled[row] == 0) continue;
    const bool neighbours = last >= 0 && row - last <= largest_gap;
    if (neighbours) std::fill(filled + last + 1, filled + row, std::min(filled[last], filled[row]));
    last = row;
  }
}

/// Only single columns: a sensor whose azimuth steps are a little wider than ours.
void SightImage::fillBetweenColumns(int column, const std::vector<Range>& beams, std::vector<Range>& between) const {
  const Range* left = beams.data() + startOf(column - 1);
  const Range* right = beams.data() + startOf(column + 1);
  const Range* middle = beams.data() + startOf(column);
  Range* filled = between.data() + startOf(column);
  for (int row = 0; row < rows_; ++row) {
    const bool is_between = middle[row] == 0 && left[row] != 0 && right[row] != 0;
    filled[row] = is_between ? std::min(left[row], right[row]) : middle[row];
  }
}

void SightImage::erodeUpright(int column, const std::vector<Range>& between, std::vector<Range>& upright) const {
  const Range* ranges = between.data() + startOf(column);
  Range* result = upright.data() + startOf(column);
  for (int row = 0; row < rows_; ++row) {
    const Range below = row > 0 ? ranges[row - 1] : Range{0}, above = row + 1 < rows_ ? ranges[row + 1] : Range{0};
    result[row] = nearer(ranges[row], nearer(below, above));
  }
}

void SightImage::erodeAcross(int column, const std::vector<Range>& between, const std::vector<Range>& upright) {
  const Range* left = upright.data() + startOf(column - 1);
  const Range* right = upright.data() + startOf(column + 1);
  const Range* middle = upright.data() + startOf(column);
  const Range* known = between.data() + startOf(column);
  Range* result = nearest_.data() + startOf(column);
  for (int row = 0; row < rows_; ++row) {
    result[row] = known[row] != 0 ? nearer(middle[row], nearer(left[row], right[row])) : Range{0};
  }
}

bool SightImage::looksAt(const Eigen::Vector3f& point) const {
  const SightPixels::Pixel pixel = SightPixels::of(point);
  return pixel.valid && covered_[static_cast<std::size_t>(pixel.column)] != 0;
}

std::size_t SightImage::coveredColumns() const {
  return static_cast<std::size_t>(std::count(covered_.begin(), covered_.end(), 1));
}

double SightImage::answerBytes() { return static_cast<double>(kPixels * sizeof(Range)); }

SightImage::Sight SightImage::ofNearestBeam(const Eigen::Vector3f& point, float margin, int rows) const {
  SightPixels::Pixel pixel = SightPixels::of(point);
  const int row = pixel.row;
  Sight sight = read(hit_, pixel, margin);
  for (int away = 1; away <= rows && sight == Sight::kUnknown; ++away) {
    for (const int beam : {row - away, row + away}) {
      pixel.row = beam;
      if (sight == Sight::kUnknown) sight = read(hit_, pixel, margin);
    }
  }
  return sight;
}

std::size_t SightImage::memoryBytes() const { return (nearest_.capacity() + hit_.capacity()) * sizeof(Range); }

}  // namespace donex
