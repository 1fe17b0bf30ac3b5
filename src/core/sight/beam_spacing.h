// How far apart a sensor's beams lie, measured in what it sees (algorithm: "The sensor measures itself").
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/sight/sight_pixels.h"

namespace donex {

struct BeamSpacingOptions {
  int column_stride = 16;          ///< columns are read so far apart: spacing is much the same all around
  int widest_gap = 20;             ///< rows: where so many have no echo between two, nobody looked there
  std::uint32_t least_rows = 100;  ///< that the gaps of a band cover; with fewer it has the spacing of all bands
};

/// The angle between the two beams that a place lies between, by elevation: of all places, so wide gaps count by their
/// width. Spinning, solid-state and non-repetitive sensors are alike to it.
class BeamSpacing {
 public:
  explicit BeamSpacing(const BeamSpacingOptions& options = {}) : options_(options) {}

  /// Measures anew. `hits` has the ranges of one column after the other, from `first_row` on, 0 where nothing came
  /// back.
  void measure(const std::vector<std::uint16_t>& hits, int first_row, int rows);

  /// Tangent of the angle around a row of the image; 0 where nothing was measured.
  float at(int row) const { return by_band_[static_cast<std::size_t>(row / kRowsOfBand)]; }
  float everywhere() const { return everywhere_; }
  /// Outermost rows with an echo; no beams: the lowest above the highest.
  SightPixels::Span span() const { return span_; }

 private:
  static constexpr int kRowsOfBand = 16;  // about 5 degrees: sensors have finer beams where the road is
  static constexpr std::size_t kBands = SightPixels::kRows / kRowsOfBand + 1;
  /// Lengths of gaps [rows].
  struct Sums {
    std::uint32_t rows = 0, squares = 0;
    float mean() const { return static_cast<float>(squares) / static_cast<float>(rows) * SightPixels::kRowHeight; }
  };

  void readColumn(const std::uint16_t* hits, int first_row, int rows, std::array<Sums, kBands>& bands);

  BeamSpacingOptions options_;
  std::array<float, kBands> by_band_{};
  float everywhere_ = 0.0F;
  SightPixels::Span span_{SightPixels::kRows, -1};
};

}  // namespace donex
