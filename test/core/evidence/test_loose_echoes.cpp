#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "core/evidence/loose_echoes.h"
#include "core/pi.h"

namespace donex {
namespace {

using Echoes = std::vector<Eigen::Vector3f>;
using Loose = std::vector<std::uint8_t>;

/// A sensor that looks as often as clear air is looked at.
class Sensor {
 public:
  explicit Sensor(const LooseEchoes::Options& options = {}) : finder_(options) {}

  Loose looseIn(const Echoes& echoes) {
    SightPixels seen;
    seen.project(echoes, std::vector<std::uint8_t>(echoes.size(), 1));
    std::vector<ClusterRole> roles(echoes.size(), ClusterRole::kConnects);
    stamp_ += LooseEchoes::Options().interval;
    finder_.loosen(TurnPart::kWhole, stamp_, seen, roles);
    Loose is_loose;
    for (const ClusterRole role : roles) is_loose.push_back(role == ClusterRole::kLoose ? 1 : 0);
    return is_loose;
  }

  void reset() { finder_.reset(); }

 private:
  LooseEchoes finder_;
  double stamp_ = 100.0;
};

Loose looseInThickAir(const Echoes& echoes) {
  LooseEchoes::Options thick;
  thick.thick_air[0].share = -1.0;
  thick.least = 0.0;
  Sensor sensor(thick);
  sensor.looseIn(echoes);  // until something is known of the air
  return sensor.looseIn(echoes);
}

/// The definition, echo by echo: of those within `reach` pixels, few are at its range.
bool isLoosePlainly(const Echoes& echoes, const std::vector<SightPixels::Pixel>& pixels, std::size_t i) {
  const LooseEchoes::Options options;
  const double like = options.like + options.like_angle * echoes[i].norm();
  for (int reach = 1; reach <= options.farthest; ++reach) {
    int neighbours = 0, alike = 0;
    for (std::size_t j = 0; j < echoes.size(); ++j) {
      constexpr int kColumns = SightPixels::kColumns;
      const int across = (pixels[j].column - pixels[i].column + kColumns + kColumns / 2) % kColumns - kColumns / 2;
      const bool is_beside = std::abs(across) <= reach && std::abs(pixels[j].row - pixels[i].row) <= reach;
      if (j == i || !is_beside) continue;
      ++neighbours;
      alike += std::abs(echoes[j].norm() - echoes[i].norm()) <= like ? 1 : 0;
    }
    if (neighbours >= options.neighbours) return alike < options.share * neighbours;
  }
  return false;
}

/// A wall 15 m ahead as `beams` beams a degree see it, some rays stopped on their way.
Echoes wallWithDrops(double share, int columns_a_degree, int beams_a_degree, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
  Echoes echoes;
  for (int c = -20 * columns_a_degree; c < 20 * columns_a_degree; ++c) {
    for (int b = -5 * beams_a_degree; b < 5 * beams_a_degree; ++b) {
      const float turn = static_cast<float>(c) / static_cast<float>(columns_a_degree) * kPiF / 180.0F;
      const float tilt = static_cast<float>(b) / static_cast<float>(beams_a_degree) * kPiF / 180.0F;
      const Eigen::Vector3f ray(1.0F, std::tan(turn), std::tan(tilt) / std::cos(turn));
      const float on_its_way = uniform(random), stops = uniform(random);
      echoes.push_back(15.0F * (stops < share ? 0.1F + 0.7F * on_its_way : 1.0F) * ray);
    }
  }
  return echoes;
}

TEST(LooseEchoes, AreThoseOfTheDefinition) {
  for (const int columns : {2, 6}) {
    const Echoes echoes = wallWithDrops(0.2, columns, 2, 7);
    const Loose is_loose = looseInThickAir(echoes);
    std::vector<SightPixels::Pixel> pixels;
    for (const Eigen::Vector3f& echo : echoes) pixels.push_back(SightPixels::of(echo));
    int loose = 0;
    for (std::size_t i = 0; i < echoes.size(); ++i) {
      ASSERT_EQ(is_loose[i] != 0, isLoosePlainly(echoes, pixels, i)) << i << " at " << echoes[i].transpose();
      loose += is_loose[i];
    }
    EXPECT_GT(loose, 10);
  }
}

TEST(LooseEchoes, DropsAreAndTheWallBehindThemIsNot) {
  const Echoes echoes = wallWithDrops(0.03, 12, 2, 3);
  Sensor sensor;
  sensor.looseIn(echoes);
  const Loose is_loose = sensor.looseIn(echoes);
  std::size_t drops = 0, found = 0;
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    const bool is_drop = echoes[i].x() < 14.0F;
    drops += is_drop ? 1 : 0;
    found += is_drop && is_loose[i] != 0 ? 1 : 0;
    EXPECT_FALSE(!is_drop && is_loose[i] != 0) << echoes[i].transpose();
  }
  EXPECT_GT(drops, 80U);
  EXPECT_GT(static_cast<double>(found), 0.95 * static_cast<double>(drops));
}

TEST(LooseEchoes, AreNotToldApartInClearAir) {
  const Echoes rain = wallWithDrops(0.03, 12, 2, 3), clear = wallWithDrops(0.0007, 12, 2, 3);
  const auto any = [](const Loose& loose) { return std::count(loose.begin(), loose.end(), 1) > 0; };
  EXPECT_TRUE(any(looseInThickAir(clear))) << "a few drops";
  Sensor sensor;
  EXPECT_FALSE(any(sensor.looseIn(rain))) << "nothing is known yet";
  EXPECT_TRUE(any(sensor.looseIn(rain)));
  for (int i = 0; i < 40; ++i) sensor.looseIn(clear);
  EXPECT_FALSE(any(sensor.looseIn(clear))) << "the rain has passed";
  sensor.looseIn(rain);
  EXPECT_TRUE(any(sensor.looseIn(rain)));
  sensor.reset();
  EXPECT_FALSE(any(sensor.looseIn(rain)));
}

/// Where a tree stands, each echo has a depth of its own: most have nearer and farther ones beside them.
TEST(LooseEchoes, LeavesAreNoThickAir) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> depth(0.4F, 1.0F);
  Echoes echoes = wallWithDrops(0.0, 12, 2, 1);
  for (Eigen::Vector3f& echo : echoes) {
    const bool hits_the_tree = std::abs(echo.y() / echo.x()) < 0.03F;
    if (hits_the_tree) echo *= depth(random);
  }
  const Loose none(echoes.size(), 0);
  Sensor sensor;
  for (int i = 0; i < 10; ++i) EXPECT_EQ(sensor.looseIn(echoes), none) << i;
}

/// The wall, seen through a cloud 6 m ahead and 4 m deep.
Echoes wallBehindACloud() {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
  Echoes echoes = wallWithDrops(0.0, 6, 3, 1);
  for (Eigen::Vector3f& echo : echoes) {
    const float depth = uniform(random), stops = uniform(random);
    const bool is_in_cloud = std::abs(echo.y() / echo.x()) < 0.2F && stops < 0.5F;
    if (is_in_cloud) echo *= (4.0F + 4.0F * depth) / echo.x();
  }
  return echoes;
}

/// Stopped on its way to the wall.
bool isDrop(const Eigen::Vector3f& echo) { return echo.x() < 14.0F; }

/// How many of the cloud's echoes, and of the wall's, are loose.
std::array<double, 2> looseShares(const Echoes& echoes, const Loose& is_loose) {
  std::array<double, 2> all{}, loose{};
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    const std::size_t kind = isDrop(echoes[i]) ? 0 : 1;
    ++all[kind];
    loose[kind] += is_loose[i];
  }
  return {loose[0] / all[0], loose[1] / all[1]};
}

TEST(LooseEchoes, CloudsAre) {
  const Echoes echoes = wallBehindACloud();
  const auto [of_cloud, of_wall] = looseShares(echoes, looseInThickAir(echoes));
  EXPECT_GT(of_cloud, 0.9);
  EXPECT_LT(of_wall, 0.02);
}

TEST(LooseEchoes, InAPlumeWhatIsCloseByTells) {
  const Echoes echoes = wallBehindACloud();
  LooseEchoes::Options plume;
  plume.thick_air = {LooseEchoes::Options::ThickAir{20.0, 1.0}, LooseEchoes::Options::ThickAir{8.0, -1.0}};
  plume.least = 0.0;
  Sensor sensor(plume);
  sensor.looseIn(echoes);
  const auto [of_cloud, of_wall] = looseShares(echoes, sensor.looseIn(echoes));
  EXPECT_GT(of_cloud, 1.0 - 0.5 * (1.0 - looseShares(echoes, looseInThickAir(echoes))[0]))
      << "half of the rest at least";
  EXPECT_LT(of_wall, 0.02);
}

TEST(LooseEchoes, WhatIsConnectedOfACloudIsAPlumeAndAWallIsNot) {
  LooseEchoes::Options thick;
  thick.thick_air = {LooseEchoes::Options::ThickAir{20.0, -1.0}, LooseEchoes::Options::ThickAir{20.0, -1.0}};
  thick.least = 0.0;
  LooseEchoes finder(thick);
  const Echoes echoes = wallBehindACloud();
  SightPixels seen;
  seen.project(echoes, std::vector<std::uint8_t>(echoes.size(), 1));
  std::vector<ClusterRole> roles(echoes.size(), ClusterRole::kConnects);
  finder.loosen(TurnPart::kWhole, 100.0, seen, roles);
  std::array<std::vector<std::uint32_t>, 2> things;  // the cloud, the wall
  for (std::uint32_t i = 0; i < echoes.size(); ++i) things[isDrop(echoes[i]) ? 0 : 1].push_back(i);
  std::fill(roles.begin(), roles.end(), ClusterRole::kConnects);
  things[0].push_back(static_cast<std::uint32_t>(echoes.size()));  // of another cloud: says nothing here
  roles.push_back(ClusterRole::kConnects);
  EXPECT_TRUE(finder.loosenPlume(seen, things[0].data(), things[0].size(), roles));
  EXPECT_FALSE(finder.loosenPlume(seen, things[1].data(), things[1].size(), roles));
  for (std::uint32_t i = 0; i < echoes.size(); ++i) {
    EXPECT_EQ(roles[i] == ClusterRole::kLoose, isDrop(echoes[i])) << i;
  }
  EXPECT_EQ(roles.back(), ClusterRole::kConnects);
  LooseEchoes in_clear_air;
  in_clear_air.loosen(TurnPart::kWhole, 100.0, seen, roles);
  EXPECT_FALSE(in_clear_air.loosenPlume(seen, things[0].data(), things[0].size(), roles));
}

TEST(LooseEchoes, AirThatWasThickClearsLater) {
  LooseEchoes::Options options;
  options.thick_air = {LooseEchoes::Options::ThickAir{20.0, 0.025}, LooseEchoes::Options::ThickAir{8.0, 1.0}};
  const Echoes downpour = wallWithDrops(0.08, 6, 3, 1), drizzle = wallWithDrops(0.035, 6, 3, 2);
  const auto isLoosened = [&](Sensor& sensor) {
    const Loose loose = sensor.looseIn(drizzle);
    return std::count(loose.begin(), loose.end(), 1) > 0;
  };
  Sensor before(options), after(options);
  before.looseIn(drizzle);
  before.looseIn(drizzle);
  EXPECT_FALSE(isLoosened(before)) << "by itself that is clear air";
  after.looseIn(downpour);
  after.looseIn(drizzle);
  EXPECT_TRUE(isLoosened(after)) << "after a downpour it is not yet";
}

TEST(LooseEchoes, JoinWhatMovesCloseBy) {
  LooseEchoes::Options thick;
  thick.thick_air[0].share = -1.0;
  thick.least = 0.0;
  LooseEchoes finder(thick);
  const Echoes echoes = wallWithDrops(0.0, 6, 3, 1);
  SightPixels seen;
  seen.project(echoes, std::vector<std::uint8_t>(echoes.size(), 1));
  std::vector<ClusterRole> roles(echoes.size(), ClusterRole::kConnects);
  finder.loosen(TurnPart::kWhole, 100.0, seen, roles);
  // The left half moves; one echo of each half, and one at the border, is loose.
  std::vector<Proof> proofs;
  for (const Eigen::Vector3f& echo : echoes) proofs.push_back(echo.y() > 0.0F ? Proof::kEnteredFree : Proof::kNone);
  const auto at = [&](float y) {
    const auto nearest = std::min_element(echoes.begin(), echoes.end(), [&](const auto& a, const auto& b) {
      const Eigen::Vector3f place(15.0F, y, 0.0F);
      return (a - place).norm() < (b - place).norm();
    });
    return static_cast<std::size_t>(nearest - echoes.begin());
  };
  const std::size_t moving = at(2.0F), standing = at(-2.0F);
  roles[moving] = roles[standing] = ClusterRole::kLoose;
  proofs[moving] = Proof::kNone;
  finder.join(seen, roles, proofs);
  EXPECT_EQ(proofs[moving], Proof::kEnteredFree);
  EXPECT_EQ(proofs[standing], Proof::kNone);
}

TEST(LooseEchoes, PolesAndFewEchoesAreNot) {
  Echoes echoes = wallWithDrops(0.0, 5, 2, 1);
  for (Eigen::Vector3f& echo : echoes) {
    const bool hits_the_pole = std::abs(echo.y() / echo.x()) < 0.005F;  // 0.1 m wide, 10 m away
    if (hits_the_pole) echo *= 10.0F / echo.x();
  }
  for (const std::uint8_t loose : looseInThickAir(echoes)) EXPECT_EQ(loose, 0);
  EXPECT_EQ(looseInThickAir({{5.0F, 0.0F, 0.0F}, {9.0F, 0.0F, 0.0F}}), (Loose{0, 0}));
}

TEST(LooseEchoes, NothingIsSaidOfWhatIsNoEcho) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const Echoes echoes{{nan, 1.0F, 1.0F}, {inf, 0.0F, 0.0F}, {0.0F, 0.0F, 5.0F}, {0.0F, 0.0F, 0.0F}};
  EXPECT_EQ(looseInThickAir(echoes), Loose(4, 0));
  EXPECT_TRUE(looseInThickAir({}).empty());
}

}  // namespace
}  // namespace donex
