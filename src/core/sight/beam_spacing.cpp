#include "core/sight/beam_spacing.h"

#include <algorithm>

namespace donex {

void BeamSpacing::measure(const std::vector<std::uint16_t>& hits, int first_row, int rows) {
  std::array<Sums, kBands> bands{};
  span_ = {SightPixels::kRows, -1};
  for (int column = 0; column < SightPixels::kColumns; column += options_.column_stride) {
    readColumn(hits.data() + static_cast<std::ptrdiff_t>(column) * rows, first_row, rows, bands);
  }
  Sums all;
  for (const Sums& band : bands) {
    all.rows += band.rows;
    all.squares += band.squares;
  }
  everywhere_ = all.rows > 0 ? all.mean() : 0.0F;
  for (std::size_t b = 0; b < kBands; ++b) {
    by_band_[b] = bands[b].rows >= options_.least_rows ? bands[b].mean() : everywhere_;
  }
}

void BeamSpacing::readColumn(const std::uint16_t* hits, int first_row, int rows, std::array<Sums, kBands>& bands) {
  int below = -1;
  for (int row = 0; row < rows; ++row) {
    if (hits[row] == 0) continue;
    span_.lowest = std::min(span_.lowest, first_row + row);
    span_.highest = std::max(span_.highest, first_row + row);
    const int gap = row - below;
    if (below >= 0 && gap <= options_.widest_gap) {
      Sums& band = bands[static_cast<std::size_t>((first_row + (row + below) / 2) / kRowsOfBand)];
      band.rows += static_cast<std::uint32_t>(gap);
      band.squares += static_cast<std::uint32_t>(gap * gap);
    }
    below = row;
  }
}

}  // namespace donex
