// After the first scans the paper's rule allocates nothing more, and takes the memory that was said before.
#include <algorithm>
#include <tuple>

#include <gtest/gtest.h>

#include "donex/detector.h"
#include "donex/memory_bound.h"
#include "simulation/simulator.h"
#include "support/counted_allocations.h"
#include "support/random_scans.h"

namespace donex {
namespace {

constexpr std::size_t kEchoes = 30000;

/// Scans of exactly kEchoes echoes: random ones, repeated.
std::vector<Scan> scansOfOneSize(double voxel_size) {
  testing::RandomScans random(11, voxel_size, 40.0F);
  std::vector<Scan> scans;
  for (int k = 0; k < 24; ++k) {
    scans.push_back(random.next(static_cast<int>(kEchoes)));
    std::vector<Eigen::Vector3f>& echoes = scans.back().echoes;
    if (echoes.empty()) echoes.emplace_back(5.0F, 0.0F, 0.0F);
    for (std::size_t i = 0; echoes.size() < kEchoes; ++i) echoes.push_back(echoes[i]);
  }
  return scans;
}

class SteadyState : public ::testing::TestWithParam<Method> {};

TEST_P(SteadyState, AllocatesNothingAScan) {
  const Config config = paperConfig(GetParam());
  const std::vector<Scan> scans = scansOfOneSize(config.voxel_size);
  const auto detector = makeDetector(config);
  EchoLabels labels;
  for (std::size_t k = 0; k < 4; ++k) detector->process(scans[k], labels);
  const std::size_t before = testing::allocations();
  std::size_t dynamic = 0;
  for (std::size_t k = 4; k < scans.size(); ++k) {
    detector->process(scans[k], labels);
    for (const std::uint8_t label : labels.dynamic) dynamic += label;
  }
  EXPECT_EQ(testing::allocations() - before, 0U);
  EXPECT_GT(dynamic, 1000U);
}

TEST_P(SteadyState, TakesWhatWasSaid) {
  using Setting = std::pair<double, int>;
  for (const auto& [voxel_size, threads] : {Setting{0.4, 1}, Setting{0.2, 1}, Setting{0.2, 2}, Setting{0.1, 1}}) {
    Config config = paperConfig(GetParam());
    config.voxel_size = voxel_size;
    config.threads = threads;
    const std::vector<Scan> scans = scansOfOneSize(voxel_size);
    EchoLabels labels;
    labels.resize(kEchoes);
    const std::size_t before = testing::liveBytes();
    const auto detector = makeDetector(config);
    for (const Scan& scan : scans) detector->process(scan, labels);
    const auto taken = static_cast<double>(testing::liveBytes() - before);
    EXPECT_NEAR(memoryBound(config, kEchoes), taken, 0.1 * taken) << voxel_size << " m, " << threads;
    EXPECT_NEAR(static_cast<double>(detector->memoryBytes()), taken, 0.1 * taken) << voxel_size << " m, " << threads;
  }
}

class DefaultSteadyState : public ::testing::TestWithParam<std::tuple<Method, int>> {
 protected:
  static Config config() {
    Config config;
    std::tie(config.method, config.threads) = GetParam();
    return config;
  }
};

/// Scans of a crossing, `beams` high.
std::vector<Scan> crossing(int beams, double duration) {
  simulation::SimulatorOptions options;
  options.beams = beams;
  options.duration = duration;
  simulation::Simulator simulator("intersection", options);
  std::vector<Scan> scans;
  for (simulation::SimulatedScan scan; simulator.next(scan);) scans.push_back(scan.coreScan());
  return scans;
}

/// Nothing is allocated on a stretch of road like one that was driven before, objects and all.
TEST_P(DefaultSteadyState, AllocatesNothingAScan) {
  const std::vector<Scan> scans = crossing(32, 3.0);
  const auto detector = makeDetector(config());
  EchoLabels labels;
  std::size_t dynamic = 0, before = 0;
  for (int drive = 0; drive < 3; ++drive) {
    before = testing::allocations();
    detector->reset();
    for (const Scan& scan : scans) {
      detector->process(scan, labels);
      for (const std::uint8_t label : labels.dynamic) dynamic += label;
    }
  }
  EXPECT_EQ(testing::allocations() - before, 0U);
  EXPECT_GT(dynamic, 1000U);
}

TEST_P(DefaultSteadyState, TakesWhatWasSaid) {
  const std::vector<Scan> scans = crossing(64, 2.6);
  const auto most = std::max_element(scans.begin(), scans.end(),
                                     [](const Scan& a, const Scan& b) { return a.echoes.size() < b.echoes.size(); });
  EchoLabels labels;
  labels.resize(most->echoes.size());
  const std::size_t before = testing::liveBytes();
  const auto detector = makeDetector(config());
  for (const Scan& scan : scans) detector->process(scan, labels);
  const auto taken = static_cast<double>(testing::liveBytes() - before);
  EXPECT_NEAR(memoryBound(config(), most->echoes.size()), taken, 0.1 * taken);
  EXPECT_NEAR(static_cast<double>(detector->memoryBytes()), taken, 0.1 * taken);
}

INSTANTIATE_TEST_SUITE_P(Both, DefaultSteadyState,
                         ::testing::Combine(::testing::Values(Method::kDonex2d, Method::kDonex3d),
                                            ::testing::Values(1, 2)));
INSTANTIATE_TEST_SUITE_P(Paper, SteadyState, ::testing::Values(Method::kDonex2d, Method::kDonex3d));

}  // namespace
}  // namespace donex
