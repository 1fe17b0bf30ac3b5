// Beams without an echo: found wherever they were written, and nothing else is.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "ros/no_returns.h"

namespace donex {
namespace {

using Echoes = std::vector<Eigen::Vector3f>;

/// Directions all around, at ranges from `nearest` to `farthest` [m].
Echoes scattered(std::size_t count, float nearest, float farthest, const Eigen::Vector3f& sensor) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(-1.0F, 1.0F), range(nearest, farthest);
  Echoes echoes;
  while (echoes.size() < count) {
    const Eigen::Vector3f direction(unit(random), unit(random), 0.3F * unit(random));
    echoes.emplace_back(sensor + range(random) * direction.normalized());
  }
  return echoes;
}

std::size_t without(const Echoes& echoes) {
  std::size_t count = 0;
  for (const Eigen::Vector3f& echo : echoes) count += echo.allFinite() ? 0U : 1U;
  return count;
}

const Eigen::Vector3f kRoof(1.3F, -0.2F, 1.9F);

TEST(NoReturns, AtTheSensorWhereverTheCloudWasMoved) {
  for (const Eigen::Vector3f& sensor : {Eigen::Vector3f(0.0F, 0.0F, 0.0F), kRoof}) {
    Echoes echoes = scattered(1000, 1.0F, 60.0F, sensor);
    // As a transform in single precision leaves them.
    for (int i = 0; i < 300; ++i) echoes.emplace_back(sensor + Eigen::Vector3f(1e-6F, -1e-6F, 0.0F));
    const NoReturns found = removeNoReturns(sensor, echoes);
    EXPECT_EQ(found.at_sensor, 300U);
    EXPECT_EQ(found.at_largest_range, 0U);
    EXPECT_EQ(without(echoes), 300U);
  }
}

TEST(NoReturns, AtOneLargestRange) {
  Echoes echoes = scattered(1000, 1.0F, 60.0F, kRoof);
  for (const Eigen::Vector3f& end : scattered(400, 120.0F, 120.001F, kRoof)) echoes.push_back(end);
  const NoReturns found = removeNoReturns(kRoof, echoes);
  EXPECT_EQ(found.at_largest_range, 400U);
  EXPECT_NEAR(found.largest_range, 120.0F, 0.01F);
  EXPECT_EQ(without(echoes), 400U);
  EXPECT_EQ(removeNoReturns(kRoof, echoes).at_largest_range, 0U) << "what is left is left alone";
}

TEST(NoReturns, AWallAtTheEndOfTheRangeIsNone) {
  Echoes echoes = scattered(1000, 1.0F, 30.0F, kRoof);
  for (int i = 0; i < 4000; ++i) {  // a facade 60 m away
    echoes.emplace_back(60.0F, -20.0F + 0.01F * static_cast<float>(i), 0.5F + 0.001F * static_cast<float>(i));
  }
  EXPECT_EQ(removeNoReturns(Eigen::Vector3f::Zero(), echoes).at_largest_range, 0U);
  EXPECT_EQ(without(echoes), 0U);
}

TEST(NoReturns, AFewFarEchoesAndARoundRoomAreNone) {
  Echoes few = scattered(1000, 1.0F, 60.0F, kRoof);
  for (const Eigen::Vector3f& end : scattered(40, 120.0F, 120.001F, kRoof)) few.push_back(end);
  EXPECT_EQ(removeNoReturns(kRoof, few).at_largest_range, 0U);
  Echoes round = scattered(1000, 20.0F, 20.0001F, kRoof);
  EXPECT_EQ(removeNoReturns(kRoof, round).at_largest_range, 0U);
}

TEST(NoReturns, WhatIsNoNumberStaysSo) {
  Echoes echoes{Eigen::Vector3f::Constant(NAN), Eigen::Vector3f::Constant(INFINITY), {1.0F, 2.0F, 3.0F}};
  const NoReturns found = removeNoReturns(Eigen::Vector3f::Zero(), echoes);
  EXPECT_EQ(found.at_sensor + found.at_largest_range, 0U);
  EXPECT_EQ(without(echoes), 2U);
  Echoes none;
  EXPECT_EQ(removeNoReturns(kRoof, none).at_sensor, 0U);
}

}  // namespace
}  // namespace donex
