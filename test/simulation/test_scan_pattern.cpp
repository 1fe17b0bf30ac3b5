// What the patterns promise: fields of view, numbers of rays, the same for the same seed, new places or the same ones.
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "core/pi.h"
#include "simulation/scan_pattern.h"
#include "simulation/simulator.h"

namespace donex::simulation {
namespace {

constexpr double kDuration = 0.1;  // [s]

struct Direction {
  double azimuth, elevation;  // [deg]
};

std::vector<Direction> directionsOf(const SensorModel& model) {
  std::vector<Direction> all;
  for (int column = 0; column < model.columns(); ++column) {
    const Eigen::Vector2d heading = model.headings[static_cast<std::size_t>(column)];
    const Slopes slopes = model.slopesOf(column);
    for (std::size_t i = 0; i < slopes.size(); ++i) {
      all.push_back({std::atan2(heading.y(), heading.x()) * 180.0 / kPi,
                     std::atan(static_cast<double>(slopes[i])) * 180.0 / kPi});
    }
  }
  return all;
}

std::vector<Direction> scanOf(const char* name, std::size_t scan, std::uint64_t seed = 1) {
  SensorModel model;
  ScanPattern(*findPattern(name), kDuration, seed).aim(scan, model);
  return directionsOf(model);
}

/// Squares that hold a ray; `edge` [deg].
using Squares = std::set<std::pair<int, int>>;
void addSquares(const std::vector<Direction>& rays, double edge, Squares& squares) {
  for (const Direction& ray : rays) {
    squares.emplace(static_cast<int>(std::floor(ray.azimuth / edge)),
                    static_cast<int>(std::floor(ray.elevation / edge)));
  }
}

bool same(const std::vector<Direction>& a, const std::vector<Direction>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Direction& p, const Direction& q) {
    return p.azimuth == q.azimuth && p.elevation == q.elevation;
  });
}

class EveryPattern : public testing::TestWithParam<const char*> {};

TEST_P(EveryPattern, FillsItsFieldOfViewWithItsRays) {
  const Pattern& pattern = *findPattern(GetParam());
  double left = -400.0, right = 400.0, low = 90.0, high = -90.0;
  for (std::size_t scan = 0; scan < 5; ++scan) {
    const std::vector<Direction> rays = scanOf(GetParam(), scan);
    EXPECT_NEAR(static_cast<double>(rays.size()), pattern.ray_rate * kDuration, 0.01 * pattern.ray_rate * kDuration);
    for (const Direction& ray : rays) {
      left = std::max(left, ray.azimuth);
      right = std::min(right, ray.azimuth);
      low = std::min(low, ray.elevation);
      high = std::max(high, ray.elevation);
    }
  }
  constexpr double kRounding = 1e-3, kMargin = 0.6;  // [deg]
  EXPECT_LE(left, 0.5 * pattern.width + kRounding);
  EXPECT_GE(left, 0.5 * pattern.width - kMargin);
  EXPECT_GE(right, -0.5 * pattern.width - kRounding);
  EXPECT_LE(right, -0.5 * pattern.width + kMargin);
  EXPECT_GE(low, pattern.lowest - kRounding);
  EXPECT_LE(low, pattern.lowest + kMargin);
  EXPECT_LE(high, pattern.highest + kRounding);
  EXPECT_GE(high, pattern.highest - kMargin);
}

TEST_P(EveryPattern, IsTheSameForTheSameSeed) { EXPECT_TRUE(same(scanOf(GetParam(), 3), scanOf(GetParam(), 3))); }

TEST_P(EveryPattern, GivesTheSimulatorEchoesInsideIt) {
  const Pattern& pattern = *findPattern(GetParam());
  SimulatorOptions options;
  options.pattern = GetParam();
  for (const bool distortion : {false, true}) {
    options.distortion = distortion;
    Simulator simulator("intersection", options), again("intersection", options);
    SimulatedScan scan, other;
    ASSERT_TRUE(simulator.next(scan) && simulator.next(scan));
    ASSERT_TRUE(again.next(other) && again.next(other));
    EXPECT_GT(scan.echoes.size(), 5000U);
    ASSERT_EQ(scan.labels, other.labels);
    for (const SimulatedEcho& echo : scan.echoes) {
      const double azimuth = std::atan2(echo.position.y(), echo.position.x()) * 180.0 / kPi;
      const double elevation = std::atan2(echo.position.z(), echo.position.head<2>().norm()) * 180.0 / kPi;
      ASSERT_LE(std::abs(azimuth), 0.5 * pattern.width + 0.01);
      ASSERT_GE(elevation, pattern.lowest - 0.01);
      ASSERT_LE(elevation, pattern.highest + 0.01);
      ASSERT_GE(echo.position.norm(), pattern.min_range - 1e-3f);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Patterns, EveryPattern,
                         testing::Values("solid_state", "non_repetitive", "mid360", "avia", "hap"),
                         [](const auto& pattern) { return pattern.param; });

TEST(ScanPattern, NonRepetitiveOnesSeeMoreWithEachScan) {
  for (const char* name : {"mid360", "avia"}) {
    Squares one, ten;
    addSquares(scanOf(name, 0), 0.25, one);
    for (std::size_t scan = 0; scan < 10; ++scan) addSquares(scanOf(name, scan), 0.25, ten);
    EXPECT_GT(static_cast<double>(ten.size()), 2.0 * static_cast<double>(one.size())) << name;
    EXPECT_FALSE(same(scanOf(name, 0), scanOf(name, 1))) << name;
    EXPECT_FALSE(same(scanOf(name, 0, 1), scanOf(name, 0, 2))) << name;
  }
  // Nearly all of what it can see: 360 x 59 squares.
  Squares seen;
  for (std::size_t scan = 0; scan < 20; ++scan) addSquares(scanOf("mid360", scan), 1.0, seen);
  EXPECT_GT(seen.size(), 360U * 59U * 95U / 100U);
}

TEST(ScanPattern, SolidStateOnesSeeTheSameAgain) {
  EXPECT_TRUE(same(scanOf("hap", 0), scanOf("hap", 7)));
  EXPECT_TRUE(same(scanOf("solid_state", 2), scanOf("hap", 7)));
}

TEST(ScanPattern, CanBeNarrowedAndThinned) {
  SimulatorOptions options;
  options.pattern = "hap";
  options.view_width = 60.0;
  options.view_height = 20.0;
  options.ray_rate = 1e5;
  const Pattern pattern = options.chosenPattern();
  EXPECT_EQ(pattern.width, 60.0);
  EXPECT_EQ(pattern.lowest, -10.0);
  EXPECT_EQ(pattern.highest, 10.0);
  Simulator simulator("street", options);
  EXPECT_NEAR(simulator.beams() * simulator.columns(), 1e4, 150.0);
}

TEST(ScanPattern, WhatDoesNotGoTogetherIsNamed) {
  SimulatorOptions options;
  options.pattern = "spiral";
  ASSERT_EQ(options.faults().size(), 1U);
  EXPECT_NE(options.faults().front().find("mid360"), std::string::npos);
  options.pattern = "mid360";
  EXPECT_TRUE(options.faults().empty());
  options.beams = 16;
  EXPECT_EQ(options.faults().size(), 1U);
  options.pattern = "spinning";
  EXPECT_TRUE(options.faults().empty());
  options.ray_rate = 1e5;
  EXPECT_EQ(options.faults().size(), 1U);
}

}  // namespace
}  // namespace donex::simulation
