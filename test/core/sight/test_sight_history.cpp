// The scans that are kept, and what they say together.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "core/sight/sight_history.h"

namespace donex {
namespace {

using Evidence = SightView::Evidence;
constexpr int kAll = 1000;
constexpr double kEver = -1e9;
const SightImage::Reading kReading{true, 0.038};

/// A surface at `range` [m] around the sensor.
Scan shell(double stamp, double range, const Eigen::Isometry3d& odom_from_base = Eigen::Isometry3d::Identity()) {
  Scan scan;
  scan.stamp = stamp;
  scan.odom_from_base = odom_from_base;
  for (int azimuth = 0; azimuth < 720; ++azimuth) {
    for (int beam = -8; beam <= 8; ++beam) {
      const double angle = azimuth * M_PI / 360.0, slope = 0.02 * beam;
      const Eigen::Vector3d direction(std::cos(angle), std::sin(angle), slope);
      scan.echoes.push_back((range * direction.normalized()).cast<float>());
    }
  }
  return scan;
}

std::vector<std::uint8_t> all(const Scan& scan) { return std::vector<std::uint8_t>(scan.echoes.size(), 1); }

void add(SightHistory& history, const Scan& scan) {
  history.arrive(scan, all(scan));
  history.add(scan, all(scan));
}

int sum(const Evidence& evidence) { return evidence.free + evidence.surface + evidence.hidden; }

SightView view(const SightHistory& history) { return history.seenFrom(Eigen::Isometry3d::Identity()); }

/// Scans that know this place, near the sensor.
int kept(const SightHistory& history, double since = kEver) {
  return sum(view(history).ask(Eigen::Vector3f(5.0F, 0.0F, 0.0F), since, kAll));
}

TEST(SightHistory, ForgetsWhatIsOlderThanItsLength) {
  SightHistory history(1.0, 0.0, 0.5F, kReading);
  for (int k = 0; k <= 20; ++k) {
    add(history, shell(0.125 * k, 20.0));
    EXPECT_EQ(kept(history), std::min(k + 1, 9)) << "scan " << k;
  }
  add(history, shell(100.0, 20.0));
  EXPECT_EQ(kept(history), 1) << "after a pause";
}

TEST(SightHistory, KeepsNoMoreThanAViewHolds) {
  SightHistory history(10.0, 0.0, 0.5F, kReading);
  for (int k = 0; k <= 200; ++k) add(history, shell(0.01 * k, 20.0));
  EXPECT_EQ(kept(history), 128);
  EXPECT_EQ(kept(history, 1.995), 1) << "the newest is among them";
}

TEST(SightHistory, KeepsNoMoreThanOneScanASpacing) {
  SightHistory history(10.0, 0.25, 0.5F, kReading);
  for (int k = 0; k <= 16; ++k) add(history, shell(0.0625 * k, 20.0));  // four times as often
  EXPECT_EQ(kept(history), 5);
}

TEST(SightHistory, AsksOnlyScansLaterThanSince) {
  SightHistory history(10.0, 0.0, 0.5F, kReading);
  for (int k = 1; k <= 8; ++k) add(history, shell(k, 20.0));
  EXPECT_EQ(kept(history, 0.0), 8);
  EXPECT_EQ(kept(history, 3.5), 5);
  EXPECT_EQ(kept(history, 4.0), 4) << "a scan at `since` is not later";
  EXPECT_EQ(kept(history, 8.0), 0);
}

TEST(SightHistory, CountsFreeSurfaceAndHiddenApart) {
  SightHistory history(10.0, 0.0, 0.5F, kReading);
  double stamp = 0.0;
  for (const double range : {20.0, 10.0, 20.0, 5.0, 30.0, 10.2, 5.0}) add(history, shell(stamp += 1.0, range));
  const Evidence evidence = view(history).ask(Eigen::Vector3f(10.0F, 0.0F, 0.0F), kEver, kAll);
  EXPECT_EQ(evidence.free, 3);
  EXPECT_EQ(evidence.surface, 2);
  EXPECT_EQ(evidence.hidden, 2);
  EXPECT_EQ(sum(view(history).ask(Eigen::Vector3f(1.0F, 0.0F, 9.0F), kEver, kAll)), 0) << "above every beam";
}

/// The half of a scan behind the sensor: what lies ahead is out of view.
Scan behind(Scan scan) {
  const auto is_ahead = [](const Eigen::Vector3f& echo) { return echo.x() > 0.0F; };
  scan.echoes.erase(std::remove_if(scan.echoes.begin(), scan.echoes.end(), is_ahead), scan.echoes.end());
  return scan;
}

TEST(SightHistory, TellsForHowLongAPlaceWasOutOfViewSinceItWasFree) {
  SightHistory history(10.0, 0.0, 0.5F, kReading);
  const auto overlooked = [&] { return view(history).ask(Eigen::Vector3f(10.0F, 0.0F, 0.0F), kEver, kAll).overlooked; };
  add(history, behind(shell(0.0, 20.0)));
  add(history, shell(1.0, 20.0));
  EXPECT_EQ(overlooked(), 0.0) << "before it was free it need not have been in view";
  for (const double stamp : {1.25, 1.5, 2.0}) add(history, behind(shell(stamp, 20.0)));
  EXPECT_EQ(overlooked(), 1.0) << "each turn stands for the time since the one before";
  add(history, shell(2.5, 10.0));
  add(history, shell(3.0, 5.0));
  EXPECT_EQ(overlooked(), 1.0) << "a surface was seen, then it was hidden: in view";
  add(history, behind(shell(3.25, 20.0)));
  EXPECT_EQ(overlooked(), 1.25);
  Scan gap = shell(3.75, 20.0);
  const auto is_level = [](const Eigen::Vector3f& echo) { return std::abs(echo.z()) < 0.1F * echo.head<2>().norm(); };
  gap.echoes.erase(std::remove_if(gap.echoes.begin(), gap.echoes.end(), is_level), gap.echoes.end());
  add(history, gap);
  add(history, shell(3.875, 5.0));  // a turn is measured when it is over
  EXPECT_EQ(overlooked(), 1.25) << "between the lowest and the highest beam: nothing came back";
  add(history, shell(4.0, 20.0));
  EXPECT_EQ(overlooked(), 0.0) << "free again";
}

TEST(SightHistory, WhatOneOfTwoSensorsLooksAtIsNotOverlooked) {
  for (const bool looks_first : {true, false}) {
    SightHistory history(10.0, 0.0, 0.5F, kReading);
    for (int k = 0; k < 8; ++k) {
      Scan looks = shell(0.25 * k, k == 0 ? 20.0 : 10.0), does_not = behind(shell(0.25 * k, 20.0));
      does_not.base_from_sensor.translation().x() = -0.5;
      add(history, looks_first ? looks : does_not);
      add(history, looks_first ? does_not : looks);
    }
    const Evidence evidence = view(history).ask(Eigen::Vector3f(10.0F, 0.0F, 0.0F), kEver, kAll);
    EXPECT_EQ(evidence.surface, 7);
    EXPECT_EQ(evidence.overlooked, 0.0) << looks_first;
  }
}

/// Beams `apart`: 0.036 (2 degrees) is as those of 16 beams.
Scan sparseShell(double stamp, double range, double apart = 0.036) {
  Scan scan;
  scan.stamp = stamp;
  for (int azimuth = 0; azimuth < 720; ++azimuth) {
    for (int beam = -8; beam <= 8; ++beam) {
      const double angle = azimuth * M_PI / 360.0;
      const Eigen::Vector3d direction(std::cos(angle), std::sin(angle), apart * beam);
      scan.echoes.push_back((range * direction.normalized()).cast<float>());
    }
  }
  return scan;
}

TEST(SightHistory, BeamsFarApartAreLessSure) {
  SightHistory history(10.0, 0.0, 0.5F, kReading);
  for (int k = 0; k < 4; ++k) add(history, sparseShell(k, 60.0));
  const SightView before = history.seenBefore(Eigen::Isometry3d::Identity());
  const auto at = [&](float range) { return before.ask(Eigen::Vector3f(range, 0.0F, 0.3F), kEver, kAll); };
  struct Expected {
    float range, certain, fine;
  };
  for (const auto& [range, certain, fine] : {Expected{5.0F, 1.0F, 1.0F},
                                             {10.0F, 1.0F, 0.2F / 0.36F},
                                             {20.0F, 0.4F / 0.72F, 0.2F / 0.72F},
                                             {40.0F, 0.4F, 0.2F / 1.44F}}) {
    const Evidence evidence = at(range);
    EXPECT_EQ(evidence.free, 3) << range;
    EXPECT_NEAR(evidence.certain_free, 3.0F * certain, 0.05F) << range;
    EXPECT_NEAR(evidence.fine_free, 3.0F * fine, 0.05F) << range;
  }
}

TEST(SightHistory, WhatIsNotReadBetweenBeamsIsSure) {
  SightHistory history(10.0, 0.0, 0.5F, {false, 0.0});
  for (int k = 0; k < 4; ++k) add(history, sparseShell(k, 60.0));
  const Evidence evidence =
      history.seenBefore(Eigen::Isometry3d::Identity()).ask(Eigen::Vector3f(40.0F, 0.05F, 0.0F), kEver, kAll);
  EXPECT_EQ(evidence.free, 3);
  EXPECT_EQ(evidence.certain_free, 3.0F);
}

TEST(SightHistory, BeamsFartherApartThanTheGapAreNeighboursOnceMeasured) {
  SightHistory history(10.0, 0.0, 0.5F, kReading);
  for (int k = 0; k < 5; ++k) add(history, sparseShell(k, 60.0, 0.06));
  const Evidence evidence =
      history.seenBefore(Eigen::Isometry3d::Identity()).ask(Eigen::Vector3f(10.0F, 0.0F, 0.3F), kEver, kAll);
  EXPECT_EQ(evidence.free, 3) << "all but the first";
}

TEST(SightHistory, MeasuresTheSensorOnceATurnIsOver) {
  SightHistory history(10.0, 0.0, 0.5F, kReading);
  add(history, sparseShell(0.0, 30.0));
  EXPECT_FALSE(history.measured().has_value());
  EXPECT_EQ(history.beamsApart(), 0.0);
  add(history, sparseShell(0.1, 30.0));
  EXPECT_NEAR(history.beamsApart(), 0.036, 0.001);
  const auto sensor = history.measured();
  ASSERT_TRUE(sensor.has_value());
  EXPECT_NEAR(sensor->beams_apart, 2.06, 0.06);
  EXPECT_NEAR(sensor->lowest, -16.1, 0.3);
  EXPECT_NEAR(sensor->highest, 16.1, 0.3);
  EXPECT_EQ(sensor->around, 360.0);
  EXPECT_NEAR(sensor->turns_per_second, 10.0, 1e-6);
  EXPECT_NE(describe(*sensor).find("beams 2.0"), std::string::npos) << describe(*sensor);
  history.reset();
  EXPECT_FALSE(history.measured().has_value());
}

TEST(SightHistory, MeasuresEachSensorByItself) {
  SightHistory history(10.0, 0.0, 0.5F, kReading);
  for (int k = 0; k < 6; ++k) {
    Scan scan = k % 2 == 0 ? sparseShell(0.05 * k, 30.0) : shell(0.05 * k, 30.0);
    scan.base_from_sensor.translation() << (k % 2 == 0 ? 1.0 : -1.0), 0.0, 0.0;
    add(history, scan);
    if (k >= 3) {
      EXPECT_NEAR(history.beamsApart(), k % 2 == 0 ? 0.036 : 0.0205, 0.001) << "cloud " << k;
    }
  }
}

TEST(SightHistory, StopsOnceEnoughSawItFreeNewestFirst) {
  SightHistory history(10.0, 0.0, 0.5F, kReading);
  add(history, shell(1.0, 10.0));
  for (int k = 2; k <= 6; ++k) add(history, shell(k, 20.0));
  add(history, shell(7.0, 5.0));
  const Evidence evidence = view(history).ask(Eigen::Vector3f(10.0F, 0.0F, 0.0F), kEver, 3);
  EXPECT_EQ(evidence.free, 3);
  EXPECT_EQ(evidence.hidden, 1) << "the newest scan was asked";
  EXPECT_EQ(evidence.surface, 0) << "the oldest was not";
}

TEST(SightHistory, TheNewestScanAlone) {
  SightHistory history(10.0, 0.0, 0.5F, kReading);
  const Eigen::Vector3f place(10.0F, 0.0F, 0.0F);
  EXPECT_EQ(history.newestSeenFrom(Eigen::Isometry3d::Identity()).at(place), SightImage::Sight::kUnknown);
  add(history, shell(1.0, 20.0));
  add(history, shell(2.0, 5.0));
  EXPECT_EQ(history.newestSeenFrom(Eigen::Isometry3d::Identity()).at(place), SightImage::Sight::kHidden);
}

TEST(SightHistory, EchoesThatAreNoneAreLeftOut) {
  SightHistory history(10.0, 0.0, 0.5F, kReading);
  const Scan scan = shell(1.0, 20.0);
  const std::vector<std::uint8_t> none(scan.echoes.size(), 0);
  history.arrive(scan, none);
  history.add(scan, none);
  EXPECT_EQ(kept(history), 0);
}

TEST(SightHistory, AskedInAnyFrameWhileTheSensorMoves) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto drawPose = [&](double reach) {
    const Eigen::Vector3d axis = Eigen::Vector3d(0.05 * uniform(random), 0.05 * uniform(random), 1.0).normalized();
    return Eigen::Isometry3d(Eigen::Translation3d(reach * uniform(random), reach * uniform(random), uniform(random)) *
                             Eigen::AngleAxisd(3.0 * uniform(random), axis));
  };
  SightHistory history(10.0, 0.0, 0.5F, kReading);
  std::vector<Scan> scans;
  for (int k = 0; k < 12; ++k) {
    scans.push_back(shell(k * 0.5, 15.0 + 3.0 * uniform(random), drawPose(20.0)));
    scans.back().base_from_sensor = drawPose(1.0);
    add(history, scans.back());
  }
  const Eigen::Isometry3d odom_from_asked = drawPose(50.0);
  const SightView asked = history.seenFrom(odom_from_asked);
  int free = 0, surface = 0, hidden = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d in_odom(30.0 * uniform(random), 30.0 * uniform(random), 2.0 * uniform(random));
    Evidence expected;
    bool on_border = false;
    for (const Scan& scan : scans) {
      const Eigen::Vector3d seen = scan.odomFromSensor().inverse() * in_odom;
      const double beyond = scan.echoes.front().cast<double>().norm() - seen.norm();
      const double slope = std::abs(seen.z()) / seen.head<2>().norm();
      on_border |= std::abs(std::abs(beyond) - 0.5) < 0.03 || std::abs(slope - 0.16) < 0.01 || seen.norm() < 0.5;
      if (slope > 0.16) continue;
      expected.free += beyond > 0.5 ? 1 : 0;
      expected.surface += std::abs(beyond) <= 0.5 ? 1 : 0;
      expected.hidden += beyond < -0.5 ? 1 : 0;
    }
    if (on_border) continue;
    const Evidence evidence = asked.ask((odom_from_asked.inverse() * in_odom).cast<float>(), kEver, kAll);
    ASSERT_EQ(evidence.free, expected.free) << in_odom.transpose();
    ASSERT_EQ(evidence.surface, expected.surface) << in_odom.transpose();
    ASSERT_EQ(evidence.hidden, expected.hidden) << in_odom.transpose();
    free += evidence.free, surface += evidence.surface, hidden += evidence.hidden;
  }
  EXPECT_GT(std::min({free, surface, hidden}), 100);
}

TEST(SightHistory, ResetForgetsEverything) {
  SightHistory history(10.0, 1.0, 0.5F, kReading);
  add(history, shell(5.0, 20.0));
  EXPECT_FALSE(history.empty());
  history.reset();
  EXPECT_TRUE(history.empty());
  EXPECT_EQ(kept(history), 0);
  add(history, shell(1.0, 20.0));  // an earlier stamp than before the reset
  EXPECT_EQ(kept(history), 1);
}

TEST(SightHistory, MemoryIsBoundedOverALongDrive) {
  SightHistory history(1.0, 0.09, 0.5F, kReading);
  const Scan scan = shell(0.0, 20.0);
  std::size_t after_a_while = 0;
  for (int k = 0; k < 2000; ++k) {
    Scan next = scan;
    next.stamp = 0.1 * k;
    next.echoes.resize(static_cast<std::size_t>(500 + k % 100));
    add(history, next);
    if (k == 200) after_a_while = history.memoryBytes();
  }
  EXPECT_GT(after_a_while, 0U);
  EXPECT_LE(history.memoryBytes(), after_a_while + after_a_while / 10);
}

}  // namespace
}  // namespace donex
