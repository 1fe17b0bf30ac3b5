// Echoes of a turn's earlier parts beside the newest one: what a border cuts is one object.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/objects/parts_beside.h"
#include "core/pi.h"

namespace donex {
namespace {

/// Echoes on a circle, one per degree from `begin` to `end` [deg].
Scan arc(double begin, double end, double stamp = 0.0, double radius = 10.0) {
  Scan scan;
  scan.stamp = stamp;
  for (double at = begin + 0.5; at < end; at += 1.0) {
    const double angle = at * kRadiansPerDegree;
    scan.echoes.push_back(Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), 0.0).cast<float>());
  }
  return scan;
}

/// What the detector does around the object step; clouds come one after the other.
class Parts {
 public:
  explicit Parts(const PartsBesideOptions& options = {}) : parts(0.3, options) {}
  /// The part with what lies beside it.
  const JudgedScan& join(const Scan& scan) {
    judged = JudgedScan();
    judged.stamp = scan.stamp;
    judged.odom_from_points = scan.odomFromSensor();
    judged.points = scan.echoes;
    judged.is_echo.assign(scan.echoes.size(), 1);
    judged.heights.assign(scan.echoes.size(), 1.0F);
    judged.roles.assign(scan.echoes.size(), ClusterRole::kConnects);
    judged.places.assign(scan.echoes.size(), Place::kNew);
    pixels_.project(scan.echoes, judged.is_echo);
    part = turns_.arrive(scan, pixels_);
    judged.continues_turn = part == TurnPart::kContinuing;
    parts.join(part, scan, turns_, judged);
    return judged;
  }
  /// One segment of all entries, which is the object `id`.
  const Segment& settle(std::uint32_t id, Proof proof = Proof::kNone) {
    segments.clear();
    Segment& segment = segments.add(judged.points.size());
    for (std::uint32_t i = 0; i < judged.points.size(); ++i) segment.echoes.push_back(i);
    parts.relate(judged, segments);
    parts.settle(pixels_, segments, {Verdict{proof, false, id}}, judged);
    return segments[0];
  }
  void take(const Scan& scan, std::uint32_t id = 0) {
    join(scan);
    settle(id);
  }

  PartsBeside parts;
  JudgedScan judged;
  Segments segments;
  TurnPart part = TurnPart::kWhole;

 private:
  Turns turns_;
  SightPixels pixels_;
};

TEST(PartsBeside, WholeScansHaveNothingBeside) {
  Parts parts;
  for (int k = 0; k < 5; ++k) {
    EXPECT_EQ(parts.join(arc(0.0, 360.0, 0.1 * k)).beside, 0U);
    EXPECT_FALSE(parts.judged.continues_turn);
    EXPECT_FALSE(parts.settle(7).is_of_two_turns);
    EXPECT_EQ(parts.segments[0].object, 0U);
  }
}

/// After a turn that is not known to be in parts and one that is, stamps up to 0.2 s.
Parts afterTwoTurnsInQuarters(double radius = 10.0, const PartsBesideOptions& options = {}) {
  Parts parts(options);
  for (int q = 0; q < 8; ++q) parts.take(arc(90.0 * (q % 4), 90.0 * (q % 4) + 90.0, 0.025 * q, radius));
  return parts;
}

TEST(PartsBeside, HoldWhatTheTurnSawWithinReach) {
  Parts parts = afterTwoTurnsInQuarters();
  parts.take(arc(0.0, 90.0, 0.2));
  EXPECT_EQ(parts.part, TurnPart::kFirst);
  const JudgedScan& second = parts.join(arc(90.0, 180.0, 0.225));
  EXPECT_TRUE(second.continues_turn);
  EXPECT_EQ(second.own(), 90U);
  // 0.85 m and 0.015 rad to either side: of the part before, and of the turn before where this one has not looked yet.
  EXPECT_NEAR(static_cast<double>(second.beside), 12.0, 2.0);
  for (std::size_t i = second.own(); i < second.points.size(); ++i) {
    const double at = std::atan2(second.points[i].y(), second.points[i].x()) / kRadiansPerDegree;
    EXPECT_TRUE((at > 83.0 && at < 91.0) || (at > 179.0 || at < -173.0)) << at;
    EXPECT_EQ(second.places[i], Place::kNew);
  }
  parts.settle(0);
  EXPECT_EQ(parts.judged.points.size(), 90U) << "they are gone after the object step";
  EXPECT_EQ(parts.judged.places.size(), 90U);
}

TEST(PartsBeside, TheReachIsALengthButNotMoreThanFifteenDegrees) {
  const auto beside_at = [](double radius) {
    Parts parts = afterTwoTurnsInQuarters(radius);
    parts.take(arc(0.0, 90.0, 0.2, radius));
    return static_cast<double>(parts.join(arc(90.0, 180.0, 0.225, radius)).beside);
  };
  EXPECT_NEAR(beside_at(2.0), 30.0, 2.0);
  EXPECT_NEAR(beside_at(5.0), 22.0, 2.0);
  EXPECT_NEAR(beside_at(40.0), 5.0, 2.0);
}

TEST(PartsBeside, AnObjectThatReachesThereComesWhole) {
  Parts parts = afterTwoTurnsInQuarters();
  parts.take(arc(0.0, 90.0, 0.2), 7);
  // Its 90 echoes, with those of the turn before that were one segment with them, and those to the other side.
  EXPECT_NEAR(static_cast<double>(parts.join(arc(90.0, 180.0, 0.225)).beside), 102.0, 3.0);
  // Six degrees of it may touch the part. The rest goes with them: their clusters are theirs.
  EXPECT_NEAR(static_cast<double>(parts.judged.far), 84.0, 3.0);
  const auto& together = parts.judged.together;
  EXPECT_EQ(std::count(together.end() - static_cast<std::ptrdiff_t>(parts.judged.far), together.end(), 0U), 0);
  EXPECT_EQ(parts.settle(7).object, 7U);
  parts.join(arc(180.0, 270.0, 0.25));
  EXPECT_EQ(parts.settle(8).object, 7U) << "the echoes of both parts belong to it";
}

TEST(PartsBeside, OfALargeObjectThatStandsAFewEchoesStandForThoseFarAway) {
  const auto far = [](std::size_t large, Proof proof) {
    PartsBesideOptions options;
    options.large = large;
    Parts parts = afterTwoTurnsInQuarters(10.0, options);
    parts.join(arc(0.0, 90.0, 0.2));
    parts.settle(7, proof);
    return static_cast<double>(parts.join(arc(90.0, 180.0, 0.225)).far);
  };
  EXPECT_NEAR(far(200, Proof::kNone), 84.0, 3.0);
  EXPECT_NEAR(far(50, Proof::kNone), 21.0, 2.0);
  EXPECT_NEAR(far(50, Proof::kEnteredFree), 84.0, 3.0) << "it moves";
}

TEST(PartsBeside, ObjectsAreToldApartHoweverManyCome) {
  Parts parts = afterTwoTurnsInQuarters();
  std::uint32_t before = 0;
  for (int part = 0; part < 40; ++part) {
    parts.join(arc(90.0 * (part % 4), 90.0 * (part % 4) + 90.0, 0.2 + 0.025 * part));
    const auto next = static_cast<std::uint32_t>(100 * (part + 1));
    EXPECT_EQ(parts.settle(next).object, before);
    before = next;
  }
}

TEST(PartsBeside, ASegmentGoesOnWhereTheTurnHasNotLookedYet) {
  Parts parts = afterTwoTurnsInQuarters();
  parts.join(arc(0.0, 90.0, 0.2));
  EXPECT_TRUE(parts.settle(0).is_of_two_turns) << "the turn before stands in";
  for (const double begin : {90.0, 180.0}) parts.take(arc(begin, begin + 90.0, 0.2 + begin / 3600.0));
  parts.join(arc(270.0, 360.0, 0.275));
  EXPECT_FALSE(parts.settle(0).is_of_two_turns) << "the turn has looked everywhere";
}

TEST(PartsBeside, EntriesStayInTheWorldWhileTheVehicleMoves) {
  Parts parts = afterTwoTurnsInQuarters();
  parts.take(arc(0.0, 90.0, 0.2));
  Scan moved = arc(90.0, 180.0, 0.225);
  moved.odom_from_base.translation() = Eigen::Vector3d(0.5, 0.0, 0.0);
  const JudgedScan& second = parts.join(moved);
  for (std::size_t i = second.own(); i < second.points.size(); ++i) {
    const Eigen::Vector3f in_world = second.points[i] + Eigen::Vector3f(0.5F, 0.0F, 0.0F);
    EXPECT_NEAR(in_world.norm(), 10.0F, 1e-4F);
  }
}

TEST(PartsBeside, AnotherSensorsEchoesAreNotBeside) {
  Parts parts = afterTwoTurnsInQuarters();
  parts.take(arc(0.0, 90.0, 0.2));
  Scan other = arc(90.0, 180.0, 0.225);
  other.base_from_sensor.translation() = Eigen::Vector3d(2.0, 0.0, 0.0);
  EXPECT_EQ(parts.join(other).beside, 0U);
}

TEST(PartsBeside, WhatWasSeenTwoTurnsAgoIsForgotten) {
  Parts parts = afterTwoTurnsInQuarters();
  for (int q = 0; q < 4; ++q) parts.take(arc(90.0 * q, 90.0 * q + 90.0, 0.2 + 0.025 * q));
  // The sensor looks to the front alone from now on: nobody sees again what is beside.
  parts.take(arc(0.0, 45.0, 0.3));
  parts.take(arc(45.0, 90.0, 0.35));
  EXPECT_GT(parts.join(arc(0.0, 45.0, 0.4)).beside, 0U);
  parts.settle(0);
  parts.take(arc(45.0, 90.0, 0.45));
  const JudgedScan& later = parts.join(arc(0.0, 45.0, 0.5));
  for (std::size_t i = later.own(); i < later.points.size(); ++i) {
    EXPECT_GT(later.points[i].y(), 0.0F) << "to the right nobody has looked for two turns";
  }
}

TEST(PartsBeside, AResetForgetsThem) {
  Parts parts = afterTwoTurnsInQuarters();
  parts.take(arc(0.0, 90.0, 0.2));
  parts.parts.reset();
  EXPECT_EQ(parts.join(arc(90.0, 180.0, 0.225)).beside, 0U);
}

}  // namespace
}  // namespace donex
