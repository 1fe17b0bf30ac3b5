#include "core/evidence/loose_echoes.h"

#include <algorithm>
#include <cmath>

#include "core/grid/storage.h"

namespace donex {

/// In clear air most turns are let pass.
void LooseEchoes::beginTurn(double stamp) {
  const double elapsed = std::max(stamp - looked_, 0.0);  // other sensors' clouds may come a little late
  looks_ = !isAirClear() || elapsed >= options_.interval;
  if (!looks_) return;
  const double kept = std::exp(-elapsed / options_.memory);
  near_ *= kept;
  alone_ *= kept;
  looked_ = std::max(stamp, looked_);
}

void LooseEchoes::loosen(TurnPart part, double stamp, const SightPixels& seen, std::vector<ClusterRole>& roles) {
  if (part != TurnPart::kContinuing) beginTurn(stamp);
  if (!looks_) return;
  sort(seen);
  const bool was_clear = isAirClear();
  const float near = static_cast<float>(options_.near) / SightPixels::kRangeStep;
  for (std::size_t i = 0; i < roles.size(); i += was_clear ? options_.sample : 1) {
    if (roles[i] != ClusterRole::kConnects || seen.row(i) < 0) continue;
    const Count count = neighboursOf(seen, i);
    if (seen.range(i) < near) {
      ++near_;
      alone_ += count.isAlone() ? 1.0 : 0.0;
    }
    const bool is_loose = !was_clear && count.neighbours > 0 && count.alike < options_.share * count.neighbours;
    if (is_loose) roles[i] = ClusterRole::kLoose;
  }
}

/// A column's pixels lie side by side: those above one another are found at once.
std::size_t LooseEchoes::pixelOf(int column, int row) const {
  return static_cast<std::size_t>(column & (SightPixels::kColumns - 1)) * static_cast<std::size_t>(rows_) +
         static_cast<std::size_t>(row - lowest_row_);
}

/// The ranges by pixel: a counting sort over the rows that there are.
void LooseEchoes::sort(const SightPixels& seen) {
  const SightPixels::Span span = seen.span();
  lowest_row_ = span.lowest;
  rows_ = std::max(span.highest - span.lowest + 1, 0);
  if (first_in_.empty()) first_in_.reserve(static_cast<std::size_t>(SightPixels::kColumns) * SightPixels::kRows + 1);
  first_in_.assign(static_cast<std::size_t>(SightPixels::kColumns) * static_cast<std::size_t>(rows_) + 1, 0);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen.row(i) >= 0) ++first_in_[pixelOf(seen.column(i), seen.row(i))];
  }
  std::uint32_t end = 0;
  for (std::uint32_t& first : first_in_) first = end += first;
  resizeTo(ranges_, seen.size());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen.row(i) >= 0) ranges_[--first_in_[pixelOf(seen.column(i), seen.row(i))]] = seen.range(i);
  }
}

LooseEchoes::Count LooseEchoes::neighboursOf(const SightPixels& seen, std::size_t echo) const {
  for (int reach = 1; reach <= options_.farthest; ++reach) {
    const Count count = countAround(seen, echo, reach);
    if (count.neighbours >= options_.neighbours) return count;
  }
  return {};
}

LooseEchoes::Count LooseEchoes::countAround(const SightPixels& seen, std::size_t echo, int reach) const {
  const int column = seen.column(echo), row = seen.row(echo);
  const float range = seen.range(echo);
  const float like =
      static_cast<float>(options_.like) / SightPixels::kRangeStep + static_cast<float>(options_.like_angle) * range;
  const int lowest = std::max(row - reach, lowest_row_), highest = std::min(row + reach, lowest_row_ + rows_ - 1);
  Count count{-1, -1, 0};  // the echo finds itself
  for (int c = column - reach; c <= column + reach; ++c) {
    const std::uint32_t last = first_in_[pixelOf(c, highest) + 1];
    for (std::uint32_t i = first_in_[pixelOf(c, lowest)]; i < last; ++i) {
      ++count.neighbours;
      count.nearer += ranges_[i] < range ? 1 : 0;
      count.alike += std::abs(ranges_[i] - range) <= like ? 1 : 0;
    }
  }
  return count;
}

double LooseEchoes::bytesFor(double echoes) {
  constexpr double kPixels = static_cast<double>(SightPixels::kColumns) * SightPixels::kRows;
  return (kPixels + 1.0) * sizeof(std::uint32_t) + roomFor(sizeof(float) * echoes);
}

std::size_t LooseEchoes::memoryBytes() const {
  return first_in_.capacity() * sizeof(std::uint32_t) + ranges_.capacity() * sizeof(float);
}

}  // namespace donex
