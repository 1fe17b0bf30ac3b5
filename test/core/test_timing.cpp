#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "core/timing.h"

namespace donex {
namespace {

TEST(Quantile, IsTheNearestRank) {
  const std::vector<double> values{40.0, 10.0, 30.0, 20.0};
  EXPECT_EQ(quantile(values, 0.0), 10.0);
  EXPECT_EQ(quantile(values, 0.25), 10.0);
  EXPECT_EQ(quantile(values, 0.26), 20.0);
  EXPECT_EQ(quantile(values, 0.5), 20.0);
  EXPECT_EQ(quantile(values, 0.99), 40.0);
  EXPECT_EQ(quantile(values, 1.0), 40.0);
  EXPECT_EQ(quantile({}, 0.5), 0.0);
}

TEST(Quantile, HasItsShareOfTheValuesBelow) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(0.0, 1.0);
  for (int round = 0; round < 200; ++round) {
    std::vector<double> values(1 + random() % 50);
    for (double& value : values) value = any(random);
    const double fraction = any(random), found = quantile(values, fraction);
    const auto up_to = std::count_if(values.begin(), values.end(), [&](double value) { return value <= found; });
    EXPECT_GE(static_cast<double>(up_to), fraction * static_cast<double>(values.size()));
    EXPECT_LT(static_cast<double>(up_to - 1), fraction * static_cast<double>(values.size()));
  }
}

TEST(Clocks, CountTheWorkInBetween) {
  const double wall = wallTime(), cpu = cpuTime();
  volatile double sum = 0.0;
  while (cpuTime() - cpu < 0.01) sum = sum + 1.0;
  EXPECT_GE(wallTime() - wall, 0.0099) << "one thread cannot work for longer than it takes";
}

}  // namespace
}  // namespace donex
