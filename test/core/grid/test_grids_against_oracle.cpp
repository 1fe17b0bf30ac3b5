// The fast grids give the oracle's labels and the oracle's memory, echo by echo, on whole scans and on parts.
#include <random>

#include <gtest/gtest.h>

#include "core/grid/grid_2d.h"
#include "core/grid/grid_3d.h"
#include "core/sight/ray_index.h"
#include "donex/detector.h"
#include "support/oracle.h"
#include "support/random_scans.h"
#include "support/sectors.h"

namespace donex {
namespace {

struct Case {
  unsigned seed;
  double voxel_size;
  Compensation compensation;
  int threads;
};

Config smallGrid(Method method, const Case& c) {
  Config config = paperConfig(method);
  config.compensation = c.compensation;
  config.voxel_size = c.voxel_size;
  config.threads = c.threads;
  config.region = {-6.0, 9.0, -7.0, 5.0, -2.0, 3.0};
  return config;
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    for (const double size : {0.25, 0.3, 1.0}) {
      for (const Compensation compensation : {Compensation::kScroll, Compensation::kResample}) {
        all.push_back({seed, size, compensation, 1 + static_cast<int>(seed % 3)});
      }
    }
  }
  return all;
}

constexpr int kScans = 25;
constexpr int kEchoes = 600;  // three blocks: one per thread at most

using Ranges = std::map<oracle::Donex2d::Cell, HeightRange>;

void expectSame(const oracle::Voxels& memory, const oracle::Voxels& expected) { ASSERT_EQ(memory, expected); }
void expectSame(const Ranges& memory, const Ranges& expected) {
  ASSERT_EQ(memory.size(), expected.size());
  for (const auto& [cell, range] : expected) {
    ASSERT_EQ(memory.count(cell), 1U);
    ASSERT_EQ(memory.at(cell).lo, range.lo);
    ASSERT_EQ(memory.at(cell).hi, range.hi);
  }
}

void expectSameMemory(const Grid3d<RayIndex>& grid, const oracle::Donex3d& oracle) {
  oracle::Voxels voxels;
  for (const Index3& v : grid.remembered()) voxels.insert(oracle::absolute(v, grid.window()));
  expectSame(voxels, oracle.memory());
}

void expectSameMemory(const Grid2d& grid, const oracle::Donex2d& oracle) {
  Ranges ranges;
  for (int x = 0; x < grid.window().extent().x(); ++x) {
    for (int y = 0; y < grid.window().extent().y(); ++y) {
      const HeightRange range = grid.rangeAt(x, y);
      const oracle::Voxel v = oracle::absolute({x, y, 0}, grid.window());
      if (!range.empty()) ranges[{v[0], v[1]}] = range;
    }
  }
  expectSame(ranges, oracle.memory());
}

template <class Grid, class Oracle>
void compareGrid(const Config& config, unsigned seed) {
  testing::RandomScans scans(seed, config.voxel_size, 12.0F);
  Oracle oracle(config);
  Grid grid(config);
  EchoLabels labels;
  std::size_t new_echoes = 0;
  for (int k = 0; k < kScans; ++k) {
    const Scan scan = scans.next(kEchoes);
    const oracle::Labels expected = oracle.process(scan);
    grid.beginTurn(scan.odom_from_base);
    grid.take(scan, labels);
    for (std::size_t i = 0; k > 0 && i < expected.size(); ++i) {
      ASSERT_EQ(labels.dynamic[i], expected[i]) << "scan " << k << " echo " << i;
      new_echoes += labels.dynamic[i];
    }
    ASSERT_NO_FATAL_FAILURE(expectSameMemory(grid, oracle)) << "scan " << k;
  }
  EXPECT_GT(new_echoes, 100U);
}

template <class Oracle>
void compareDetector(const Config& config, unsigned seed) {
  testing::RandomScans scans(seed, config.voxel_size, 12.0F);
  Oracle oracle(config);
  const auto detector = makeDetector(config);
  EchoLabels labels;
  for (int k = 0; k < kScans; ++k) {
    const Scan scan = scans.next(kEchoes);
    detector->process(scan, labels);
    ASSERT_EQ(labels.dynamic, oracle.process(scan)) << "scan " << k;
  }
}

/// Scans as clouds of turns, each from where the vehicle is by then, and by one sensor or another.
template <class Grid, class Oracle>
void compareGridOnParts(const Config& config, unsigned seed) {
  testing::RandomScans scans(seed, config.voxel_size, 12.0F);
  std::mt19937 random(seed);
  oracle::OfParts<Oracle> oracle(config);
  Grid grid(config);
  EchoLabels labels;
  std::size_t new_echoes = 0;
  int turns = 0;
  for (int k = 0; k < kScans; ++k) {
    Scan cloud = scans.next(kEchoes);
    if (random() % 2 == 0) cloud.base_from_sensor = Eigen::Translation3d(2.0, 0.5, -0.25);
    if (k == 0 || random() % 4 == 0) {
      ++turns;
      oracle.beginTurn();
      grid.beginTurn(cloud.odom_from_base);
    }
    const oracle::Labels expected = oracle.take(cloud);
    grid.take(cloud, labels);
    for (std::size_t i = 0; turns > 1 && i < expected.size(); ++i) {
      ASSERT_EQ(labels.dynamic[i], expected[i]) << "cloud " << k << " echo " << i;
      new_echoes += labels.dynamic[i];
    }
    ASSERT_NO_FATAL_FAILURE(expectSameMemory(grid, oracle.wholeScans())) << "cloud " << k;
  }
  EXPECT_GT(new_echoes, 100U);
}

/// What the parts are together, in their order: where resampled contents meet in one voxel, the first one stays.
Scan together(const std::vector<Scan>& parts) {
  Scan scan = parts.front();
  scan.echoes.clear();
  for (const Scan& part : parts) scan.echoes.insert(scan.echoes.end(), part.echoes.begin(), part.echoes.end());
  return scan;
}

/// Parts of a turn at one pose have together the labels, and leave the memory, of the whole scan.
template <class Oracle>
void comparePartsWithWhole(const Config& config, unsigned seed) {
  testing::RandomScans scans(seed, config.voxel_size, 12.0F);
  Oracle whole(config);
  oracle::OfParts<Oracle> in_parts(config);
  for (int k = 0; k < kScans; ++k) {
    const std::vector<Scan> parts = testing::sectorsOf(scans.next(kEchoes / 2), 1 + static_cast<std::size_t>(k) % 5);
    in_parts.beginTurn();
    oracle::Labels labels;
    for (const Scan& part : parts) {
      const oracle::Labels of_part = in_parts.take(part);
      labels.insert(labels.end(), of_part.begin(), of_part.end());
    }
    ASSERT_EQ(labels, whole.process(together(parts))) << "scan " << k;
    ASSERT_NO_FATAL_FAILURE(expectSame(in_parts.wholeScans().memory(), whole.memory())) << "scan " << k;
  }
}

class AgainstOracle : public ::testing::TestWithParam<Case> {
 protected:
  static Config config(Method method) { return smallGrid(method, GetParam()); }
  static unsigned seed() { return GetParam().seed; }
};

TEST_P(AgainstOracle, Grid3d) { compareGrid<Grid3d<RayIndex>, oracle::Donex3d>(config(Method::kDonex3d), seed()); }

TEST_P(AgainstOracle, Detector3d) { compareDetector<oracle::Donex3d>(config(Method::kDonex3d), seed() + 1000); }

TEST_P(AgainstOracle, Grid2d) { compareGrid<Grid2d, oracle::Donex2d>(config(Method::kDonex2d), seed() + 2000); }

TEST_P(AgainstOracle, Detector2d) { compareDetector<oracle::Donex2d>(config(Method::kDonex2d), seed() + 3000); }

TEST_P(AgainstOracle, Grid3dOnParts) {
  compareGridOnParts<Grid3d<RayIndex>, oracle::Donex3d>(config(Method::kDonex3d), seed() + 4000);
}

TEST_P(AgainstOracle, Grid2dOnParts) {
  compareGridOnParts<Grid2d, oracle::Donex2d>(config(Method::kDonex2d), seed() + 5000);
}

TEST_P(AgainstOracle, ItsPartsAreTogetherTheWholeIn3d) {
  comparePartsWithWhole<oracle::Donex3d>(config(Method::kDonex3d), seed() + 6000);
}

TEST_P(AgainstOracle, ItsPartsAreTogetherTheWholeIn2d) {
  comparePartsWithWhole<oracle::Donex2d>(config(Method::kDonex2d), seed() + 7000);
}

class Parts : public ::testing::TestWithParam<std::tuple<Method, Compensation, int>> {};

TEST_P(Parts, HaveTogetherTheLabelsOfTheWhole) {
  const auto [method, compensation, parts] = GetParam();
  const auto whole = makeDetector(smallGrid(method, {8, 0.25, compensation, 1}));
  const auto in_parts = makeDetector(smallGrid(method, {8, 0.25, compensation, 2}));
  testing::RandomScans scans(8, 0.25, 12.0F);
  EchoLabels expected, of_part;
  std::size_t dynamic = 0;
  for (int k = 0; k < kScans; ++k) {
    const std::vector<Scan> sectors = testing::sectorsOf(scans.next(20000), static_cast<std::size_t>(parts));
    whole->process(together(sectors), expected);
    EchoLabels labels;
    for (const Scan& sector : sectors) {
      in_parts->process(sector, of_part);
      labels.dynamic.insert(labels.dynamic.end(), of_part.dynamic.begin(), of_part.dynamic.end());
      labels.observed.insert(labels.observed.end(), of_part.observed.begin(), of_part.observed.end());
    }
    ASSERT_EQ(labels.dynamic, expected.dynamic) << "scan " << k;
    ASSERT_EQ(labels.observed, expected.observed) << "scan " << k;
    for (const std::uint8_t label : labels.dynamic) dynamic += label;
  }
  EXPECT_GT(dynamic, 1000U);
}

INSTANTIATE_TEST_SUITE_P(Paper, Parts,
                         ::testing::Combine(::testing::Values(Method::kDonex2d, Method::kDonex3d),
                                            ::testing::Values(Compensation::kScroll, Compensation::kResample),
                                            ::testing::Values(2, 4, 10)));

class Threads : public ::testing::TestWithParam<std::tuple<Method, Compensation, int>> {};

TEST_P(Threads, ChangeNothing) {
  const auto [method, compensation, threads] = GetParam();
  const auto alone = makeDetector(smallGrid(method, {7, 0.25, compensation, 1}));
  const auto together = makeDetector(smallGrid(method, {7, 0.25, compensation, threads}));
  testing::RandomScans scans(7, 0.25, 12.0F);
  EchoLabels expected, labels;
  std::size_t dynamic = 0;
  for (int k = 0; k < kScans; ++k) {
    const Scan scan = scans.next(20000);
    alone->process(scan, expected);
    together->process(scan, labels);
    ASSERT_EQ(labels.dynamic, expected.dynamic) << "scan " << k;
    ASSERT_EQ(labels.observed, expected.observed);
    ASSERT_EQ(together->reasons(), alone->reasons());
    ASSERT_EQ(together->dynamicCells(), alone->dynamicCells());
    for (const std::uint8_t label : labels.dynamic) dynamic += label;
  }
  EXPECT_GT(dynamic, 1000U);
}

INSTANTIATE_TEST_SUITE_P(Paper, Threads,
                         ::testing::Combine(::testing::Values(Method::kDonex2d, Method::kDonex3d),
                                            ::testing::Values(Compensation::kScroll, Compensation::kResample),
                                            ::testing::Values(2, 3)));

INSTANTIATE_TEST_SUITE_P(Random, AgainstOracle, ::testing::ValuesIn(cases()));

}  // namespace
}  // namespace donex
