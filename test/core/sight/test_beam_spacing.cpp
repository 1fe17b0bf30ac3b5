// How far apart beams lie: against the mean over all places, one by one, and on rings as sensors have them.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/sight/beam_spacing.h"

namespace donex {
namespace {

constexpr float kRow = SightPixels::kRowHeight;
constexpr int kFirstRow = 100, kRows = 200;

using Hits = std::vector<std::uint16_t>;

Hits none() { return Hits(static_cast<std::size_t>(SightPixels::kColumns) * kRows, 0); }

/// `is_hit(column, row)`.
template <class IsHit>
Hits imageOf(IsHit&& is_hit) {
  Hits hits = none();
  for (int column = 0; column < SightPixels::kColumns; ++column) {
    for (int row = 0; row < kRows; ++row) {
      hits[static_cast<std::size_t>(column * kRows + row)] = is_hit(column, row) ? 500 : 0;
    }
  }
  return hits;
}

BeamSpacing measured(const Hits& hits) {
  BeamSpacing spacing;
  spacing.measure(hits, kFirstRow, kRows);
  return spacing;
}

TEST(BeamSpacing, RingsLieAsFarApartAsTheirRows) {
  for (const int every : {1, 2, 5, 12}) {
    const BeamSpacing spacing = measured(imageOf([&](int, int row) { return row % every == 0; }));
    EXPECT_NEAR(spacing.everywhere(), static_cast<float>(every) * kRow, 1e-6F) << every;
    EXPECT_NEAR(spacing.at(kFirstRow + 80), static_cast<float>(every) * kRow, 1e-6F) << every;
    EXPECT_EQ(spacing.span().lowest, kFirstRow);
    EXPECT_EQ(spacing.span().highest, kFirstRow + (kRows - 1) / every * every);
  }
}

TEST(BeamSpacing, SensorsMayHaveFinerBeamsSomewhere) {
  const BeamSpacing spacing = measured(imageOf([](int, int row) { return row > 100 || row % 4 == 0; }));
  EXPECT_NEAR(spacing.at(kFirstRow + 40), 4.0F * kRow, 1e-6F);
  EXPECT_NEAR(spacing.at(kFirstRow + 150), kRow, 1e-6F);
}

TEST(BeamSpacing, WhereNobodyLookedThereAreNoNeighbours) {
  const BeamSpacing spacing = measured(imageOf([](int, int row) { return row < 50 ? row % 3 == 0 : row > 120; }));
  EXPECT_NEAR(spacing.at(kFirstRow + 20), 3.0F * kRow, 1e-6F);
  EXPECT_EQ(spacing.at(kFirstRow + 85), spacing.everywhere()) << "between them as everywhere";
  EXPECT_LT(spacing.everywhere(), 3.0F * kRow);
}

TEST(BeamSpacing, IsTheMeanOfAllPlacesAtRandomEchoes) {
  std::mt19937 random(3);
  for (const double share : {0.08, 0.3, 0.7}) {
    std::bernoulli_distribution is_hit(share);
    const Hits hits = imageOf([&](int, int) { return is_hit(random); });
    double sum = 0.0, places = 0.0;
    for (int column = 0; column < SightPixels::kColumns; column += BeamSpacingOptions().column_stride) {
      const std::uint16_t* ranges = hits.data() + static_cast<std::ptrdiff_t>(column) * kRows;
      for (int row = 1; row < kRows; ++row) {  // the place between this row and the one below
        int above = row, below = row - 1;
        while (above < kRows && ranges[above] == 0) ++above;
        while (below >= 0 && ranges[below] == 0) --below;
        if (above == kRows || below < 0 || above - below > BeamSpacingOptions().widest_gap) continue;
        sum += above - below;
        places += 1.0;
      }
    }
    EXPECT_NEAR(measured(hits).everywhere(), sum / places * kRow, 1e-5) << share;
  }
}

TEST(BeamSpacing, OfNothingNothingIsKnown) {
  const BeamSpacing unmeasured, of_nothing = measured(none());
  for (const BeamSpacing& spacing : {unmeasured, of_nothing}) {
    EXPECT_EQ(spacing.everywhere(), 0.0F);
    EXPECT_EQ(spacing.at(200), 0.0F);
    EXPECT_GT(spacing.span().lowest, spacing.span().highest);
  }
}

}  // namespace
}  // namespace donex
