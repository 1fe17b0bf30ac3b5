#include "core/sight/direction_sets.h"

namespace donex {
namespace {

constexpr int kColumns = SightPixels::kColumns;

/// With those next to them, to both sides, so many times.
ColumnSet grown(ColumnSet columns, int times) {
  for (int i = 0; i < times; ++i) {
    columns |= columns << 1 | columns >> (kColumns - 1) | columns >> 1 | columns << (kColumns - 1);
  }
  return columns;
}

}  // namespace

ColumnSet setOf(const Turns::Columns& columns) {
  ColumnSet set;
  for (std::size_t c = 0; c < columns.size(); ++c) set[c] = columns[c] != 0;
  return set;
}

ColumnSet columnsIn(const Turns::Directions& directions) {
  ColumnSet set;
  for (std::size_t c = 0; c < directions.size(); ++c) set[c] = directions[c] != 0;
  return set;
}

ColumnSet shrunk(const ColumnSet& columns, int times) { return ~grown(~columns, times); }

Turns::Directions closed(const Turns::Directions& directions, int border) {
  Turns::Directions result = directions;
  const auto step = [&](auto&& join) {
    const Turns::Directions before = result;
    for (std::size_t c = 0; c < before.size(); ++c) {
      const Turns::Bands left = before[(c + before.size() - 1) % before.size()],
                         right = before[(c + 1) % before.size()];
      result[c] = join(join(before[c], left), right);
    }
  };
  for (int i = 0; i < border; ++i) step([](Turns::Bands a, Turns::Bands b) { return a | b; });
  for (int i = 0; i <= border; ++i) step([](Turns::Bands a, Turns::Bands b) { return a & b; });
  return result;
}

Turns::Bands withoutEnds(Turns::Bands bands) {
  return bands == Turns::kAllBands ? bands : bands & (bands << 1) & (bands >> 1);
}

}  // namespace donex
