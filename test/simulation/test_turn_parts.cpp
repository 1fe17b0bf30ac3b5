// Turns in parts: together they are the turn, and each comes when it was measured.
#include <gtest/gtest.h>

#include "core/sector.h"
#include "simulation/same_scan.h"
#include "simulation/simulator.h"

namespace donex::simulation {
namespace {

constexpr double kPeriod = 0.1;     // [s]
constexpr double kRounding = 1e-7;  // [s] a time within a scan is a float

SimulatorOptions cutInto(int parts, bool distortion, const std::string& pattern = "spinning") {
  SimulatorOptions options;
  options.parts = parts;
  options.distortion = distortion;
  options.pattern = pattern;
  options.beams = pattern == "spinning" ? 16 : 0;
  options.start_stamp = 20.0;
  options.duration = 0.3;
  return options;
}

std::vector<SimulatedScan> scansOf(const std::string& scene, const SimulatorOptions& options) {
  Simulator simulator(scene, options);
  std::vector<SimulatedScan> scans;
  SimulatedScan scan;
  while (simulator.next(scan)) scans.push_back(scan);
  EXPECT_EQ(scans.size(), simulator.size());
  return scans;
}

void append(const std::vector<OdometrySample>& from, std::vector<OdometrySample>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

/// Whose odometry is whose by the stamps alone.
void expectSameOdometry(const std::vector<SimulatedScan>& turns, const std::vector<SimulatedScan>& parts) {
  std::vector<OdometrySample> whole, put_together;
  for (const SimulatedScan& turn : turns) append(turn.odometry, whole);
  for (const SimulatedScan& part : parts) {
    append(part.odometry, put_together);
    for (const OdometrySample& sample : part.odometry) EXPECT_LE(sample.stamp, part.sent + kRounding);
  }
  ASSERT_LE(whole.size(), put_together.size());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_EQ(whole[i].stamp, put_together[i].stamp);
    EXPECT_EQ(whole[i].odom_from_base.matrix(), put_together[i].odom_from_base.matrix());
  }
}

/// Rays in the order of firing: parts one after the other are the turn.
void expectSharesOf(const SimulatedScan& turn, const SimulatedScan* parts, std::size_t count) {
  std::size_t next = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const SimulatedScan& part = parts[k];
    const double end = turn.stamp - kPeriod * (1.0 - static_cast<double>(k + 1) / static_cast<double>(count));
    EXPECT_NEAR(part.stamp, end, kRounding);
    EXPECT_EQ(part.sent, part.stamp);
    ASSERT_LE(next + part.echoes.size(), turn.echoes.size());
    for (std::size_t i = 0; i < part.echoes.size(); ++i, ++next) {
      const auto time = static_cast<double>(part.echoes[i].time);
      ASSERT_TRUE(sameRay(part.echoes[i], turn.echoes[next]));
      ASSERT_NEAR(part.stamp + time, turn.stamp + static_cast<double>(turn.echoes[next].time), kRounding);
      ASSERT_LE(time, kRounding);
      ASSERT_GE(time, -kPeriod / static_cast<double>(count) - kRounding);
      ASSERT_EQ(part.labels[i], turn.labels[next]);
    }
  }
  EXPECT_EQ(next, turn.echoes.size());
}

TEST(TurnParts, WithDistortionEachHoldsTheRaysOfItsShare) {
  for (const char* pattern : {"spinning", "solid_state", "mid360"}) {
    const auto turns = scansOf("street", cutInto(1, true, pattern));
    ASSERT_EQ(turns.size(), 3U);
    for (const int count : {2, 4, 10, 40}) {
      const auto parts = scansOf("street", cutInto(count, true, pattern));
      const auto each = static_cast<std::size_t>(count);
      ASSERT_EQ(parts.size(), 3U * each);
      for (std::size_t i = 0; i < turns.size(); ++i) expectSharesOf(turns[i], &parts[i * each], each);
      expectSameOdometry(turns, parts);
    }
  }
}

TEST(TurnParts, WithDistortionEachHasThePoseOfItsTime) {
  const SimulatorOptions options = cutInto(10, true);
  const Simulator simulator("turning", options);
  for (const SimulatedScan& part : scansOf("turning", options)) {
    EXPECT_TRUE(part.odom_from_base.isApprox(simulator.odomFromBase(part.stamp), 1e-9));
  }
}

TEST(TurnParts, WithoutDistortionTheyAreSectorsOneAfterTheOther) {
  for (const char* pattern : {"spinning", "mid360"}) {
    const auto turns = scansOf("street", cutInto(1, false, pattern));
    for (const std::size_t count : {2U, 4U, 10U, 40U}) {
      const auto parts = scansOf("street", cutInto(static_cast<int>(count), false, pattern));
      ASSERT_EQ(parts.size(), turns.size() * count);
      for (std::size_t turn = 0; turn < turns.size(); ++turn) {
        std::vector<std::size_t> next(count, 0);
        for (std::size_t i = 0; i < turns[turn].echoes.size(); ++i) {
          const std::size_t sector = sectorOf(turns[turn].echoes[i].position, count);
          const SimulatedScan& part = parts[turn * count + sector];
          const std::size_t place = next[sector]++;
          ASSERT_LT(place, part.echoes.size());
          ASSERT_TRUE(sameRay(part.echoes[place], turns[turn].echoes[i]));
          ASSERT_EQ(part.labels[place], turns[turn].labels[i]);
        }
        for (std::size_t k = 0; k < count; ++k) {
          const SimulatedScan& part = parts[turn * count + k];
          EXPECT_EQ(next[k], part.echoes.size());
          EXPECT_EQ(part.stamp, turns[turn].stamp);
          EXPECT_EQ(part.odom_from_base.matrix(), turns[turn].odom_from_base.matrix());
          EXPECT_NEAR(part.sent, part.stamp + kPeriod * static_cast<double>(k) / static_cast<double>(count), kRounding);
        }
      }
      expectSameOdometry(turns, parts);
    }
  }
}

/// A car that pulls out moves in the last parts of the turn and stands in the first ones.
TEST(TurnParts, TheTruthIsThatOfThePartsOwnTime) {
  SimulatorOptions options = cutInto(10, true);
  options.duration = 6.0;
  const Simulator truth("parked_car_leaves", options);
  const auto parts = scansOf("parked_car_leaves", options);
  std::size_t changed = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const double end_of_turn = parts[k - k % 10 + 9].stamp;
    for (const std::uint32_t label : parts[k].labels) {
      const std::size_t instance = label >> 16;
      if (instance == 0) continue;
      ASSERT_EQ(label, truth.mover(instance - 1, parts[k].stamp).label);
      changed += label != truth.mover(instance - 1, end_of_turn).label ? 1 : 0;
    }
  }
  EXPECT_GT(changed, 0U);
}

TEST(TurnParts, TheOwnBodyComesWhenTheBeamPassesIt) {
  SimulatorOptions options = cutInto(4, true);
  options.disturbance.own_body = true;
  const auto parts = scansOf("street", options);
  std::size_t more = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    for (const SimulatedEcho& echo : parts[k].echoes) {
      if (echo.time < 0.0F) continue;
      ++more;
      const bool is_left = echo.position.y() >= 0.0F, is_ahead = echo.position.x() >= 0.0F;
      EXPECT_EQ(k, is_left ? (is_ahead ? 1U : 0U) : (is_ahead ? 2U : 3U)) << "from behind, clockwise from above";
    }
  }
  EXPECT_EQ(more, 400U);
}

TEST(TurnParts, TheSameSeedGivesTheSameParts) {
  const auto first = scansOf("crowd", cutInto(10, true));
  const auto again = scansOf("crowd", cutInto(10, true));
  for (std::size_t k = 0; k < first.size(); ++k) EXPECT_TRUE(sameScan(first[k], again[k]));
}

TEST(TurnParts, WhatIsNoNumberOfPartsIsRefused) {
  for (const int parts : {0, -1, 1001}) {
    const std::vector<std::string> expected{"parts is " + std::to_string(parts) + ", must be between 1 and 1000"};
    EXPECT_EQ(cutInto(parts, true).faults(), expected);
  }
  const std::vector<std::string> expected{
      "parts without distortion are sectors all around, where these sensors do not look: add distortion"};
  EXPECT_EQ(cutInto(10, false, "solid_state").faults(), expected);
  EXPECT_TRUE(cutInto(10, true, "solid_state").faults().empty());
}

}  // namespace
}  // namespace donex::simulation
