// Which clouds are one turn: nothing but their directions tells.
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/sight/sampled_turns.h"
#include "core/sight/sight_history.h"

namespace donex {
namespace {

/// Echoes at azimuths `from` to `to` [deg].
Scan sector(double stamp, double from, double to, double range = 20.0) {
  Scan scan;
  scan.stamp = stamp;
  for (double azimuth = from + 0.1; azimuth < to; azimuth += 0.2) {
    for (int beam = -4; beam <= 4; ++beam) {
      const double angle = azimuth * M_PI / 180.0;
      const Eigen::Vector3d direction(std::cos(angle), std::sin(angle), 0.02 * beam);
      scan.echoes.push_back((range * direction.normalized()).cast<float>());
    }
  }
  return scan;
}

/// Number of each cloud's turn.
std::vector<int> turnsOf(const std::vector<Scan>& clouds) {
  Turns turns;
  SightPixels pixels;
  std::vector<int> result;
  int turn = 0;
  for (const Scan& cloud : clouds) {
    pixels.project(cloud.echoes, std::vector<std::uint8_t>(cloud.echoes.size(), 1));
    turn += turns.arrive(cloud, pixels) != TurnPart::kContinuing ? 1 : 0;
    result.push_back(turn);
  }
  return result;
}

TEST(Turns, AFirstPartIsToldByTheTurnBefore) {
  Turns turns;
  SightPixels pixels;
  const auto arrive = [&](double stamp, double from, double to) {
    const Scan cloud = sector(stamp, from, to);
    pixels.project(cloud.echoes, std::vector<std::uint8_t>(cloud.echoes.size(), 1));
    return turns.arrive(cloud, pixels);
  };
  EXPECT_EQ(arrive(0.0, 0.0, 360.0), TurnPart::kWhole);
  EXPECT_EQ(arrive(0.1, 0.0, 180.0), TurnPart::kWhole) << "as long as nothing follows";
  EXPECT_EQ(arrive(0.15, 180.0, 360.0), TurnPart::kContinuing);
  EXPECT_EQ(arrive(0.2, 0.0, 180.0), TurnPart::kFirst);
  EXPECT_EQ(arrive(0.3, 0.0, 180.0), TurnPart::kWhole) << "the turn before was one cloud";
  EXPECT_EQ(turns.cloudsPerTurn(), 1U);
  EXPECT_EQ(arrive(0.35, 180.0, 360.0), TurnPart::kContinuing);
  EXPECT_EQ(turns.cloudsPerTurn(), 2U);
  turns.reset();
  EXPECT_EQ(turns.cloudsPerTurn(), 1U);
  EXPECT_EQ(arrive(0.4, 0.0, 180.0), TurnPart::kWhole) << "nothing was before";
}

TEST(Turns, WholeScansAreATurnEach) {
  EXPECT_EQ(turnsOf({sector(0.0, 0.0, 360.0), sector(0.1, 0.0, 360.0), sector(0.2, 0.0, 360.0)}),
            (std::vector<int>{1, 2, 3}));
}

TEST(Turns, AnyScanOfAnEverNarrowFieldOfViewIsATurn) {
  EXPECT_EQ(turnsOf({sector(0.0, -20.0, 20.0), sector(0.01, -20.0, 20.0), sector(0.02, -20.0, 20.0)}),
            (std::vector<int>{1, 2, 3}));
}

TEST(Turns, PartsOfATurnAreOneHoweverMany) {
  for (const int parts : {2, 4, 10, 40, 180}) {
    std::vector<Scan> clouds;
    std::vector<int> expected;
    for (int k = 0; k < 3 * parts; ++k) {
      const double width = 360.0 / parts;
      clouds.push_back(sector(0.1 * k / parts, width * (k % parts), width * (k % parts + 1)));
      expected.push_back(1 + k / parts);
    }
    EXPECT_EQ(turnsOf(clouds), expected) << parts << " parts";
  }
}

/// Echoes all around from one slope to another.
Scan band(double stamp, double from, double to) {
  Scan scan;
  scan.stamp = stamp;
  for (double azimuth = 0.1; azimuth < 360.0; azimuth += 0.3) {
    for (double slope = from; slope < to; slope += 0.01) {
      const double angle = azimuth * M_PI / 180.0;
      scan.echoes.push_back((20.0 * Eigen::Vector3d(std::cos(angle), std::sin(angle), slope)).cast<float>());
    }
  }
  return scan;
}

TEST(Turns, BandsOfElevationAreOne) {
  std::vector<Scan> clouds{band(0.0, -0.4, 0.1)};
  std::vector<int> expected{1};
  for (int k = 0; k < 9; ++k) {
    clouds.push_back(band(0.1 + 0.02 * (k % 3) + 0.1 * (k / 3), -0.4 + 0.17 * (k % 3), -0.24 + 0.17 * (k % 3)));
    expected.push_back(2 + k / 3);
  }
  EXPECT_EQ(turnsOf(clouds), expected);
}

TEST(Turns, AScanThatSeesLessThanBeforeIsWholeAllTheSame) {
  EXPECT_EQ(turnsOf({band(0.0, -0.4, 0.4), band(0.1, -0.4, 0.0), band(0.2, -0.4, 0.0), band(0.3, -0.4, 0.4)}),
            (std::vector<int>{1, 2, 3, 4}));
}

TEST(Turns, SectorsInAnyOrder) {
  std::vector<Scan> clouds;
  std::vector<int> expected;
  for (int k = 0; k < 20; ++k) {
    const int part = (k * 3) % 10;
    clouds.push_back(sector(0.01 * k, 36.0 * part, 36.0 * (part + 1)));
    expected.push_back(1 + k / 10);
  }
  EXPECT_EQ(turnsOf(clouds), expected);
}

TEST(Turns, LostPartsDelayNothing) {
  std::vector<Scan> clouds;
  for (int k = 0; k < 12; ++k) {
    if (k == 5) continue;  // the second turn's second quarter
    clouds.push_back(sector(0.025 * k, 90.0 * (k % 4), 90.0 * (k % 4 + 1)));
  }
  EXPECT_EQ(turnsOf(clouds), (std::vector<int>{1, 1, 1, 1, 2, 2, 2, 3, 3, 3, 3}));
}

TEST(Turns, APartThatComesTwiceBeginsATurn) {
  EXPECT_EQ(turnsOf({sector(0.0, 0.0, 90.0), sector(0.025, 90.0, 180.0), sector(0.026, 90.0, 180.0)}),
            (std::vector<int>{1, 1, 2}));
}

/// Such clouds are tests, or a sensor that sees next to nothing: nothing tells what a turn is.
TEST(Turns, AHandfulOfEchoesIsATurn) {
  const std::vector<Scan> clouds{sector(0.0, 0.0, 0.9), sector(0.1, 90.0, 90.9), sector(0.2, 180.0, 270.0), Scan(),
                                 sector(0.3, 180.0, 270.0)};
  EXPECT_EQ(turnsOf(clouds), (std::vector<int>{1, 2, 3, 4, 5}));
}

TEST(Turns, AHandfulOfEchoesGoesOnWithAStreamOfParts) {
  EXPECT_EQ(turnsOf({sector(0.0, 0.0, 90.0), sector(0.025, 90.0, 180.0), sector(0.05, 180.0, 180.9), Scan(),
                     sector(0.075, 270.0, 360.0), sector(0.1, 0.0, 0.9), sector(0.125, 90.0, 180.0)}),
            (std::vector<int>{1, 1, 1, 1, 1, 2, 2}));
}

TEST(Turns, ASampleOfTheEchoesTellsThem) {
  SampledTurns turns;
  for (int k = 0; k < 30; ++k) {
    Scan cloud = sector(0.01 * k, 36.0 * (k % 10), 36.0 * (k % 10 + 1));
    const std::vector<Eigen::Vector3f> once = cloud.echoes;
    // Beam by beam, with the upper ones in the sky: a step of 16 would meet none but those.
    cloud.echoes.clear();
    for (const Eigen::Vector3f& echo : once) {
      cloud.echoes.insert(cloud.echoes.end(), 15, Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
      cloud.echoes.push_back(echo);
    }
    ASSERT_GT(cloud.echoes.size(), SampledTurns::kSample);
    EXPECT_EQ(turns.arrive(cloud) == TurnPart::kContinuing, k % 10 != 0) << k;
  }
}

TEST(Turns, SeveralSensorsShareThem) {
  std::vector<Scan> clouds;
  for (int k = 0; k < 6; ++k) {
    clouds.push_back(sector(0.05 * k, -90.0, 90.0));
    if (k % 2 != 0) clouds.back().base_from_sensor = Eigen::Translation3d(2.0, 0.0, 0.0);
  }
  EXPECT_EQ(turnsOf(clouds), (std::vector<int>{1, 1, 2, 2, 3, 3}));
}

TEST(Turns, NoneIsLongerThanItMayBe) {
  std::vector<Scan> clouds;
  for (int k = 0; k < 8; ++k) clouds.push_back(sector(0.08 * k, 10.0 * k, 10.0 * k + 10.0));
  EXPECT_EQ(turnsOf(clouds), (std::vector<int>{1, 1, 1, 1, 2, 2, 2, 2}));
}

/// As the detector uses it.
void take(SightHistory& history, const Scan& scan) {
  const std::vector<std::uint8_t> is_echo(scan.echoes.size(), 1);
  history.arrive(scan, is_echo);
  history.add(scan, is_echo);
}

TEST(Turns, APartIsOneLookAndReplacesNothingElse) {
  SightHistory history(2.0, 0.09, 0.5F, {true, 0.038});
  const Eigen::Isometry3d here = Eigen::Isometry3d::Identity();
  const Eigen::Vector3f left(0.0F, 10.0F, 0.0F), right(0.0F, -10.0F, 0.0F);
  constexpr int kAll = 1000;
  for (int k = 0; k < 40; ++k) take(history, sector(0.025 * k, 90.0 * (k % 4), 90.0 * (k % 4 + 1)));
  for (const auto& side : {left, right}) {
    EXPECT_EQ(history.seenFrom(here).ask(side, -1.0, kAll).free, 10);
    EXPECT_EQ(history.seenBefore(here).ask(side, -1.0, kAll).free, 9) << "the present turn is not before itself";
  }
  take(history, sector(1.0, 0.0, 180.0, 5.0));
  EXPECT_EQ(history.newestSeenFrom(here).at(left), SightImage::Sight::kHidden);
  EXPECT_EQ(history.newestSeenFrom(here).at(right), SightImage::Sight::kFree) << "seen last in the turn before";
}

TEST(Turns, PartsOnTheWaySeeFromWhereTheyWere) {
  SightHistory history(2.0, 0.09, 0.5F, {true, 0.038});
  const auto at = [](double stamp, double from, double x) {
    Scan scan = sector(stamp, from, from + 180.0);
    scan.odom_from_base = Eigen::Translation3d(x, 0.0, 0.0) * scan.odom_from_base;
    return scan;
  };
  take(history, at(0.0, 0.0, 0.0));
  take(history, at(0.05, 180.0, 3.0));
  const SightView seen = history.seenFrom(Eigen::Isometry3d::Identity());
  const auto free = [&](float x, float y) { return seen.ask(Eigen::Vector3f(x, y, 0.0F), -1.0, 10).free; };
  EXPECT_EQ(free(0.0F, 18.0F), 1);
  EXPECT_EQ(free(3.0F, -18.0F), 1);
  EXPECT_EQ(free(-17.9F, -2.0F), 0) << "the second part saw 3 m less far back";
}

}  // namespace
}  // namespace donex
