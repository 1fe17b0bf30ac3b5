// What a scan proves to be free: against a plain reading of the header, and on scenes small enough to see.
#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <random>

#include <gtest/gtest.h>

#include "core/sight/sight_image.h"
#include "support/sight_oracle.h"

namespace donex {
namespace {

using Sight = SightImage::Sight;
using oracle::Sights;
using Echoes = std::vector<Eigen::Vector3f>;

void add(SightImage& image, const Echoes& echoes, const std::vector<std::uint8_t>& is_echo,
         const SightImage::Reading& reading) {
  SightPixels pixels;
  pixels.project(echoes, is_echo);
  SightImage::Workspace workspace;
  image.add(pixels, reading, workspace);
}

SightImage imageOf(const Echoes& echoes, const SightImage::Reading& reading = {}) {
  SightImage image;
  add(image, echoes, std::vector<std::uint8_t>(echoes.size(), 1), reading);
  return image;
}

/// Surface at `range` [m] in all directions with slopes up to +-0.3, a beam every `beam_step` rows.
Echoes shell(double range, int beam_step = 2) {
  Echoes echoes;
  for (int row = 150; row <= 250; row += beam_step) {
    for (int column = 0; column < Sights::kColumns; ++column) {
      echoes.push_back(Sights::pointIn({column, row}, 0.0, 0.0, range));
    }
  }
  return echoes;
}

TEST(SightImage, WhatHasNoDirectionSaysNothing) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity(), kNaN = std::numeric_limits<float>::quiet_NaN();
  const Echoes nowhere{
      {kInfinity, kInfinity, 0.0F}, {-kInfinity, 1.0F, 1.0F}, {kNaN, 1.0F, 1.0F}, {1e30F, 1e30F, 1.0F}};
  Echoes echoes = shell(10.0);
  std::vector<std::uint8_t> is_echo(echoes.size(), 1);
  echoes.insert(echoes.end(), nowhere.begin(), nowhere.end());
  is_echo.resize(echoes.size(), 0);
  SightImage image;
  add(image, echoes, is_echo, {});
  EXPECT_EQ(image.at({5.0F, 0.0F, 0.0F}, 0.1F), Sight::kFree);
  for (const Eigen::Vector3f& point : nowhere) EXPECT_EQ(image.at(point, 0.1F), Sight::kUnknown);
}

struct Case {
  unsigned seed;
  SightImage::Reading reading;
  int echoes;
};

class AgainstPlainReading : public ::testing::TestWithParam<Case> {
 protected:
  int draw(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  double draw(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  /// Away from a pixel's borders, where rounding may choose the pixel next to it.
  Eigen::Vector3f pointIn(const Sights::Pixel& pixel, double range) {
    return Sights::pointIn(pixel, draw(-0.4, 0.4), draw(-0.4, 0.4), range);
  }
  /// Around the seam of the azimuth.
  Sights::Pixel drawPixel() { return {(Sights::kColumns - 20 + draw(0, 40)) % Sights::kColumns, draw(180, 240)}; }

  static constexpr float kMargin = 0.5F;  ///< [m]

  /// Asks somewhere in a pixel that saw as far as `range`, often near that; `seen` counts the answers.
  template <class Answer>
  void ask(const Sights::Pixel& pixel, const std::optional<double>& range, std::array<int, 4>& seen, Answer&& answer) {
    constexpr double kRounding = 0.03;  // ranges are rounded down to 0.02 m
    const double near_surface = range ? *range + draw(-1.0, 1.0) : 10.0;
    const double asked = draw(0, 1) == 0 ? draw(0.6, 60.0) : std::max(near_surface, 0.6);
    const double beyond = range ? *range - asked : 0.0;
    if (std::abs(std::abs(beyond) - kMargin) < kRounding) return;
    Sight expected = Sight::kUnknown;
    if (range) expected = beyond > kMargin ? Sight::kFree : beyond > -kMargin ? Sight::kSurface : Sight::kHidden;
    ASSERT_EQ(answer(pointIn(pixel, asked)), expected)
        << "column " << pixel[0] << " row " << pixel[1] << " asked " << asked << " seen " << range.value_or(-1.0);
    ++seen[static_cast<std::size_t>(expected)];
  }

  void drawEchoes() {
    for (int i = 0; i < GetParam().echoes; ++i) {
      echoes_.push_back(pointIn(drawPixel(), draw(1.0, 60.0)));
      is_echo_.push_back(draw(0, 9) == 0 ? 0 : 1);
    }
  }

  void compare(const SightImage& image) {
    const Sights sights(echoes_, is_echo_, GetParam().reading);
    std::array<int, 4> seen{}, through_gaps{};
    for (int i = 0; i < 8000; ++i) {
      const Sights::Pixel pixel = drawPixel();
      ask(pixel, sights.rangeAt(pixel), seen, [&](const auto& point) { return image.at(point, kMargin); });
      ask(pixel, sights.rangeThroughGaps(pixel), through_gaps,
          [&](const auto& point) { return image.throughGaps(point, kMargin); });
    }
    for (const int count : seen) EXPECT_GT(count, 20);
    for (const int count : through_gaps) EXPECT_GT(count, 20);
  }

  Echoes echoes_;
  std::vector<std::uint8_t> is_echo_;
  std::mt19937 random_{GetParam().seed};
};

TEST_P(AgainstPlainReading, EveryPixelAtRandomRanges) {
  drawEchoes();
  SightImage image;
  add(image, echoes_, is_echo_, GetParam().reading);
  compare(image);
}

/// Any parts, in any order: sectors, rows, echoes of everywhere.
TEST_P(AgainstPlainReading, PartsMakeTheImageOfTheWhole) {
  drawEchoes();
  for (const int parts : {2, 7, 40}) {
    const int kind = draw(0, 2), offset = draw(0, parts - 1);
    SightImage image;
    for (int part = 0; part < parts; ++part) {
      Echoes echoes;
      std::vector<std::uint8_t> is_echo;
      for (std::size_t i = 0; i < echoes_.size(); ++i) {
        const auto pixel = Sights::pixelOf(echoes_[i]).value();
        const int by_column = pixel[0] * parts / Sights::kColumns, by_row = pixel[1] % parts;
        const int of_echo = kind == 0 ? by_column : kind == 1 ? by_row : static_cast<int>(i) % parts;
        if (of_echo != (part * 3 + offset) % parts) continue;
        echoes.push_back(echoes_[i]);
        is_echo.push_back(is_echo_[i]);
      }
      add(image, echoes, is_echo, GetParam().reading);
    }
    compare(image);
  }
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    for (const int echoes : {60, 300, 1200}) {
      all.push_back({seed, {false, 0.038}, echoes});
      for (const double gap : {0.001, 0.02, 0.038, 0.121}) all.push_back({seed, {true, gap}, echoes});
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Random, AgainstPlainReading, ::testing::ValuesIn(cases()));

TEST(SightImage, FreeBeforeAWallSurfaceAtItHiddenBehindIt) {
  for (const bool careful : {false, true}) {
    const SightImage image = imageOf(shell(20.0, 1), {careful, 0.038});
    for (int column = 0; column < Sights::kColumns; column += 7) {
      const auto at = [&](double range) { return image.at(Sights::pointIn({column, 200}, 0.0, 0.0, range), 0.5F); };
      EXPECT_EQ(at(5.0), Sight::kFree);
      EXPECT_EQ(at(19.4), Sight::kFree);
      EXPECT_EQ(at(19.6), Sight::kSurface);
      EXPECT_EQ(at(20.4), Sight::kSurface);
      EXPECT_EQ(at(20.6), Sight::kHidden);
    }
  }
}

TEST(SightImage, TheMarginIsTheCallers) {
  const SightImage image = imageOf(shell(20.0));
  const Eigen::Vector3f before = Sights::pointIn({100, 200}, 0.0, 0.0, 18.0);
  EXPECT_EQ(image.at(before, 1.9F), Sight::kFree);
  EXPECT_EQ(image.at(before, 2.1F), Sight::kSurface);
}

TEST(SightImage, NothingBehindIsUnknownNotFree) {
  Echoes echoes = shell(20.0, 1);
  // The sky, and a dark car: no echo at all in this part.
  const auto is_dark = [](const Eigen::Vector3f& p) { return p.x() > 0.0F && std::abs(p.y()) < 3.0F; };
  echoes.erase(std::remove_if(echoes.begin(), echoes.end(), is_dark), echoes.end());
  const SightImage image = imageOf(echoes);
  EXPECT_EQ(image.at({5.0F, 0.0F, 0.0F}, 0.5F), Sight::kUnknown);
  EXPECT_EQ(image.at({5.0F, 0.0F, 4.0F}, 0.5F), Sight::kUnknown) << "above the highest beam";
  EXPECT_EQ(image.at({5.0F, 0.0F, -4.0F}, 0.5F), Sight::kUnknown) << "below the lowest beam";
  EXPECT_EQ(image.at({-5.0F, 0.0F, 0.0F}, 0.5F), Sight::kFree);
}

TEST(SightImage, NothingIsKnownOfAnEmptyScan) {
  EXPECT_EQ(imageOf({}).at({5.0F, 1.0F, 0.0F}, 0.5F), Sight::kUnknown);
  const Echoes none(3, Eigen::Vector3f(10.0F, 0.0F, 0.0F));
  SightImage image;
  add(image, none, {0, 0, 0}, {});
  EXPECT_EQ(image.at({5.0F, 0.0F, 0.0F}, 0.5F), Sight::kUnknown);
}

TEST(SightImage, AGrazingLineOfSightFreesNothing) {
  // A wall along x at y = 2, and beyond its end another one far away: lines of sight just beside the edge pass
  // through the voxels of the near wall.
  Echoes echoes;
  for (int row = 190; row <= 210; ++row) {
    for (int column = 500; column <= 560; ++column) {
      echoes.push_back(Sights::pointIn({column, row}, 0.0, 0.0, column < 530 ? 10.0 : 40.0));
    }
  }
  const Eigen::Vector3f beside_the_edge = Sights::pointIn({530, 200}, 0.0, 0.0, 10.0);
  const Eigen::Vector3f clear_of_it = Sights::pointIn({532, 200}, 0.0, 0.0, 10.0);
  EXPECT_EQ(imageOf(echoes, {false, 0.038}).at(beside_the_edge, 0.5F), Sight::kFree);
  EXPECT_EQ(imageOf(echoes, {true, 0.038}).at(beside_the_edge, 0.5F), Sight::kSurface);
  EXPECT_EQ(imageOf(echoes, {true, 0.038}).at(clear_of_it, 0.5F), Sight::kFree);
}

TEST(SightImage, SparseBeamsLeaveNoHolesUpToTheGap) {
  const Echoes sparse = shell(20.0, 6);  // 0.036 from beam to beam
  const Eigen::Vector3f between = Sights::pointIn({300, 150 + 6 * 8 + 3}, 0.0, 0.0, 10.0);
  EXPECT_EQ(imageOf(sparse, {true, 0.038}).at(between, 0.5F), Sight::kFree);
  EXPECT_EQ(imageOf(sparse, {true, 0.030}).at(between, 0.5F), Sight::kUnknown);
  EXPECT_EQ(imageOf(sparse, {false, 0.038}).at(between, 0.5F), Sight::kUnknown);
}

TEST(SightImage, WhoHandsOnIsAskedOnButNoMoreThroughGaps) {
  SightImage older = imageOf(shell(20.0, 6)), newest;
  const Eigen::Vector3f between = Sights::pointIn({300, 150 + 6 * 8 + 3}, 0.0, 0.0, 10.0);
  const Eigen::Vector3f on_beam = Sights::pointIn({300, 150 + 6 * 8}, 0.0, 0.0, 10.0);
  EXPECT_EQ(older.at(between, 0.5F), Sight::kFree);
  EXPECT_EQ(older.throughGaps(between, 0.5F), Sight::kUnknown) << "no line of sight goes there";
  EXPECT_EQ(older.throughGaps(on_beam, 0.5F), Sight::kFree);
  older.handOn(newest);
  EXPECT_EQ(older.at(between, 0.5F), Sight::kFree);
  EXPECT_EQ(older.throughGaps(on_beam, 0.5F), Sight::kUnknown);
  const Echoes nearer = shell(8.0, 6);
  add(newest, nearer, std::vector<std::uint8_t>(nearer.size(), 1), {});
  EXPECT_EQ(newest.throughGaps(on_beam, 0.5F), Sight::kHidden);
}

TEST(SightImage, TheNearestBeamAnswersBetweenBeams) {
  Echoes echoes;  // two beams, six rows apart
  for (int column = 0; column < Sights::kColumns; ++column) {
    echoes.push_back(Sights::pointIn({column, 150}, 0.0, 0.0, 20.0));
    echoes.push_back(Sights::pointIn({column, 156}, 0.0, 0.0, 8.0));
  }
  const SightImage image = imageOf(echoes);
  const auto at = [&](int row, int rows) {
    return image.ofNearestBeam(Sights::pointIn({300, row}, 0.0, 0.0, 12.0), 0.5F, rows);
  };
  EXPECT_EQ(at(150, 0), Sight::kFree);
  EXPECT_EQ(at(152, 3), Sight::kFree) << "the lower one is closer";
  EXPECT_EQ(at(154, 3), Sight::kHidden) << "the upper one is";
  EXPECT_EQ(at(152, 1), Sight::kUnknown) << "none is so close";
  EXPECT_EQ(at(148, 3), Sight::kFree);
  EXPECT_EQ(at(140, 3), Sight::kUnknown);
}

TEST(SightImage, WhatIsBuiltBeforeIsForgotten) {
  SightImage image = imageOf(shell(20.0));
  const Echoes nearer = shell(8.0);
  image.clear();
  EXPECT_EQ(image.at({5.0F, 0.0F, 0.0F}, 0.5F), Sight::kUnknown);
  add(image, nearer, std::vector<std::uint8_t>(nearer.size(), 1), {});
  EXPECT_EQ(image.at({12.0F, 0.0F, 0.0F}, 0.5F), Sight::kHidden);
  EXPECT_EQ(image.at({5.0F, 0.0F, 0.0F}, 0.5F), Sight::kFree);
}

}  // namespace
}  // namespace donex
