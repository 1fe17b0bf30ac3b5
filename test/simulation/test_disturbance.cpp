#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "simulation/disturbance.h"
#include "simulation/simulator.h"

namespace donex::simulation {
namespace {

struct Drive {
  std::vector<SimulatedEcho> echoes;
  std::vector<std::uint32_t> labels;
};

/// A wall all around, 30 m away, seen by rings from the roof.
Drive wall() {
  Drive drive;
  for (int column = 0; column < 720; ++column) {
    for (int ring = 0; ring < 16; ++ring) {
      const float turn = 0.5F * static_cast<float>(column) * 3.14159265F / 180.0F;
      const float slope = 0.02F * static_cast<float>(ring - 14);
      const Eigen::Vector3f ray(std::cos(turn), std::sin(turn), slope);
      drive.echoes.push_back({30.0F * ray.normalized(), 0.2F, 0.0F, static_cast<std::uint16_t>(ring)});
      drive.labels.push_back(252);
    }
  }
  return drive;
}

Drive disturbed(const DisturbanceOptions& options, std::size_t scan = 3, std::uint64_t seed = 1) {
  Drive drive = wall();
  Disturbance(options, seed).apply(scan, drive.echoes, drive.labels);
  EXPECT_EQ(drive.echoes.size(), drive.labels.size());
  return drive;
}

bool same(const Drive& a, const Drive& b) {
  const auto equal = [](const SimulatedEcho& x, const SimulatedEcho& y) { return x.position == y.position; };
  return a.labels == b.labels && a.echoes.size() == b.echoes.size() &&
         std::equal(a.echoes.begin(), a.echoes.end(), b.echoes.begin(), equal);
}

/// Of the wall's echoes: those that are stopped now. All of them stay on their rays and are static.
std::vector<Eigen::Vector3f> stopped(const Drive& drive) {
  const Drive before = wall();
  std::vector<Eigen::Vector3f> places;
  EXPECT_EQ(drive.echoes.size(), before.echoes.size());
  for (std::size_t i = 0; i < before.echoes.size(); ++i) {
    const Eigen::Vector3f now = drive.echoes[i].position;
    if (now == before.echoes[i].position) continue;
    EXPECT_NEAR(now.normalized().dot(before.echoes[i].position.normalized()), 1.0F, 1e-5F);
    EXPECT_LT(now.norm(), 30.0F);
    EXPECT_EQ(drive.labels[i], Disturbance::kDisturbed);
    places.push_back(now);
  }
  return places;
}

TEST(Disturbance, OffChangesNothing) {
  EXPECT_FALSE(DisturbanceOptions().any());
  EXPECT_TRUE(same(disturbed({}), wall()));
}

TEST(Disturbance, DropsAndFlakesStopTheirShareWithinReach) {
  DisturbanceOptions rain;
  rain.rain = 0.1;
  rain.rain_reach = 5.0;
  const auto drops = stopped(disturbed(rain));
  EXPECT_NEAR(static_cast<double>(drops.size()), 1152.0, 120.0);
  for (const Eigen::Vector3f& drop : drops) EXPECT_LT(drop.norm(), 5.001F);
  DisturbanceOptions snow;
  snow.snow = 0.1;
  const auto flakes = stopped(disturbed(snow));
  EXPECT_NEAR(static_cast<double>(flakes.size()), 1152.0, 120.0);
  EXPECT_TRUE(std::any_of(flakes.begin(), flakes.end(), [](const auto& flake) { return flake.norm() > 15.0F; }));
}

TEST(Disturbance, CloudsLieBehindTheVehicle) {
  DisturbanceOptions dust;
  dust.dust = 0.5;
  DisturbanceOptions spray;
  spray.spray = 0.8;
  for (const DisturbanceOptions& options : {dust, spray}) {
    const auto places = stopped(disturbed(options));
    EXPECT_GT(places.size(), 20U);
    for (const Eigen::Vector3f& place : places) {
      EXPECT_LT(place.x(), -1.5F);
      EXPECT_GT(place.x(), -10.01F);
      EXPECT_LT(std::abs(place.y()), 2.21F);
    }
  }
}

TEST(Disturbance, OwnBodyStaysWithTheSensor) {
  DisturbanceOptions options;
  options.own_body = true;
  const Drive first = disturbed(options, 3), later = disturbed(options, 4);
  const std::size_t before = wall().echoes.size();
  ASSERT_EQ(first.echoes.size(), before + 400);
  for (std::size_t i = before; i < first.echoes.size(); ++i) {
    EXPECT_LT((first.echoes[i].position - later.echoes[i].position).norm(), 0.1F);
    EXPECT_LT(first.echoes[i].position.z(), 0.0F);
    EXPECT_EQ(first.labels[i], Disturbance::kDisturbed);
  }
}

TEST(Disturbance, SecondReturnsLieBehindTheFirst) {
  DisturbanceOptions options;
  options.dual_returns = 0.2;
  const Drive drive = disturbed(options);
  const std::size_t before = wall().echoes.size();
  EXPECT_NEAR(static_cast<double>(drive.echoes.size() - before), 2304.0, 150.0);
  for (std::size_t i = before; i < drive.echoes.size(); ++i) {
    EXPECT_GT(drive.echoes[i].position.norm(), 30.29F);
    EXPECT_LT(drive.echoes[i].position.norm(), 38.01F);
  }
}

TEST(Disturbance, HalosSurroundStrongReflectorsOnly) {
  DisturbanceOptions options;
  options.bloom = 4.0;
  EXPECT_TRUE(same(disturbed(options), wall()));
  Drive drive = wall();
  drive.echoes[100].intensity = 0.95F;
  drive.labels[100] = 81;
  drive.echoes[200].intensity = 0.95F;  // moves
  Disturbance(options, 1).apply(0, drive.echoes, drive.labels);
  const std::size_t before = wall().echoes.size();
  ASSERT_EQ(drive.echoes.size(), before + 8);
  for (std::size_t i = before; i < before + 8; ++i) {
    const bool of_mover = i >= before + 4;
    EXPECT_NEAR(drive.echoes[i].position.norm(), 30.0F, 1e-3F);
    EXPECT_LT((drive.echoes[i].position - drive.echoes[of_mover ? 200 : 100].position).norm(), 1.4F);
    EXPECT_EQ(drive.labels[i], of_mover ? 0U : Disturbance::kDisturbed);
  }
}

TEST(Disturbance, IsTheSameForASeedAndAScanAndDiffersOtherwise) {
  DisturbanceOptions options;
  options.rain = 0.05;
  options.dual_returns = 0.1;
  EXPECT_TRUE(same(disturbed(options, 3, 1), disturbed(options, 3, 1)));
  EXPECT_FALSE(same(disturbed(options, 3, 1), disturbed(options, 4, 1)));
  EXPECT_FALSE(same(disturbed(options, 3, 1), disturbed(options, 3, 2)));
}

TEST(Disturbance, IsPartOfASimulatedDrive) {
  SimulatorOptions options;
  options.beams = 16;
  options.duration = 0.2;
  options.disturbance.own_body = true;
  SimulatedScan disturbed, plain;
  ASSERT_TRUE(Simulator("street", options).next(disturbed));
  options.disturbance.own_body = false;
  ASSERT_TRUE(Simulator("street", options).next(plain));
  EXPECT_EQ(disturbed.echoes.size(), plain.echoes.size() + 400);
  options.disturbance.rain = 1.5;
  EXPECT_EQ(options.faults().size(), 1U);
}

}  // namespace
}  // namespace donex::simulation
