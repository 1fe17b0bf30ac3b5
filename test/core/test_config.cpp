#include <cmath>
#include <limits>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "donex/config.h"
#include "donex/detector.h"
#include "donex/memory_bound.h"
#include "donex/parameters.h"

namespace donex {
namespace {

bool names(const std::vector<std::string>& faults, const std::string& what) {
  for (const std::string& fault : faults) {
    if (fault.find(what) != std::string::npos) return true;
  }
  return false;
}

TEST(Config, DefaultsHaveNoFault) { EXPECT_TRUE(faultsOf(Config()).empty()); }

TEST(Config, EveryFaultIsNamedAtOnce) {
  Config config;
  config.voxel_size = 0.0;
  config.evidence.birth_window = std::nan("");
  config.objects.min_echoes = -3;
  config.region.x_min = 10.0;
  config.region.x_max = -10.0;
  const auto faults = config.faults();
  for (const char* name : {"voxel_size", "birth_window", "object_min_echoes", "x_min"}) {
    EXPECT_TRUE(names(faults, name)) << name;
  }
}

TEST(Config, ARegionWithoutEndIsNotCountedInCells) {
  Config config;
  config.region.y_min = -1e71;
  const auto faults = faultsOf(config);
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_TRUE(names(faults, "y_min"));
}

TEST(Config, RegionNarrowerThanAVoxelIsRefused) {
  Config config;
  config.region.z_min = 1.0;
  config.region.z_max = 1.1;
  EXPECT_TRUE(names(config.faults(), "z_min"));
}

TEST(Config, AGridBeyondTheLimitIsRefusedBeforeItIsAllocated) {
  for (const Method method : {Method::kDonex3d, Method::kDonex2d}) {
    Config config = paperConfig(method);
    config.voxel_size = 0.02;
    config.region = {-500, 500, -500, 500, -100, 100};
    EXPECT_TRUE(config.faults().empty()) << "each value is in its range";
    EXPECT_TRUE(names(faultsOf(config), "memory_limit"));
    EXPECT_THROW(makeDetector(config), std::invalid_argument);
  }
}

TEST(Config, WhatTheGridTakesIsWhatWasSaid) {
  for (const Method method : {Method::kDonex3d, Method::kDonex2d}) {
    Config config = paperConfig(method);
    config.voxel_size = 0.1;
    const auto detector = makeDetector(config);
    const double said = memoryBound(config, 0);
    EXPECT_NEAR(static_cast<double>(detector->memoryBytes()), said, 0.1 * said);
  }
}

TEST(Config, ThePapersRuleIsWhatItSaysAndOneStepMoreIsEvidence) {
  for (const Method method : {Method::kDonex3d, Method::kDonex2d}) {
    Config config = paperConfig(method);
    EXPECT_EQ(config.method, method);
    EXPECT_TRUE(config.isPaper());
    EXPECT_FALSE(config.hasEvidence());
    config.objects.enabled = true;
    EXPECT_TRUE(config.hasEvidence());
    EXPECT_FALSE(config.isPaper());
  }
  Config other;
  other.method = Method::kRayTracing;
  EXPECT_FALSE(other.isPaper() || other.hasEvidence()) << "a method of its own";
  other.method = Method::kDonex3dZBuffer;
  EXPECT_TRUE(other.isPaper()) << "whatever the switches say";
}

/// Gives every parameter another value, one after the other.
struct ChangeOne {
  int which, at = 0;

  void operator()(const ParameterInfo&, double& value, double, double) { value += at++ == which ? 0.125 : 0.0; }
  void operator()(const ParameterInfo&, int& value, int, int) { value += at++ == which ? 1 : 0; }
  void operator()(const ParameterInfo&, bool& value) { value = (at++ == which) != value; }
  void operator()(const ParameterInfo&, std::string& value) { value += at++ == which ? "x" : ""; }
  template <class Enum, class = std::enable_if_t<std::is_enum_v<Enum>>>
  void operator()(const ParameterInfo&, Enum& value) {
    const bool is_first = value == static_cast<Enum>(0);
    if (at++ == which) value = static_cast<Enum>(is_first ? 1 : 0);
  }
};

TEST(Config, EqualsAnotherWhereNoParameterDiffers) {
  const int all = static_cast<int>(parametersOf(Config()).size());
  EXPECT_TRUE(Config() == Config());
  for (int i = 0; i < all; ++i) {
    Config other;
    visitParameters(other, ChangeOne{i});
    EXPECT_TRUE(other != Config()) << parametersOf(Config())[static_cast<std::size_t>(i)].info.name;
  }
}

TEST(Config, ParametersOfAGroupStandTogether) {
  std::vector<ParameterGroup> groups;
  for (const auto& [info, value] : parametersOf(Config())) {
    if (groups.empty() || groups.back() != info.group) groups.push_back(info.group);
  }
  const std::set<ParameterGroup> once(groups.begin(), groups.end());
  EXPECT_EQ(once.size(), groups.size());
  EXPECT_EQ(once.size(), 8U);
}

struct Names {
  std::set<std::string>& names;
  template <class... Rest>
  void operator()(const ParameterInfo& info, Rest&&...) {
    EXPECT_TRUE(names.insert(info.name).second) << info.name << " stands twice";
    EXPECT_NE(std::string(info.meaning), "") << info.name;
  }
};

TEST(Config, EveryParameterHasANameOfItsOwnAndAMeaning) {
  Config config;
  std::set<std::string> names;
  visitParameters(config, Names{names});
  EXPECT_GT(names.size(), 30U);
}

}  // namespace
}  // namespace donex
