// Objects followed over time: which of them move.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/objects/followed.h"

namespace donex {
namespace {

using testing::addVehicle;
using testing::Followed;
using testing::JudgedScene;

TEST(ProofsOfMotion, AVehicleAheadAtTheSameSpeedIsFoundByItsRear) {
  Followed followed;
  for (int k = 0; k < 30; ++k) {
    const double sensor_x = 1.2 * k;
    JudgedScene scene(0.1 * k, sensor_x);
    // Only ever in its own shadow: nothing of it is new.
    scene.face({sensor_x + 12.0, -0.9, 0.3}, {0.0, 1.8, 0.0}, 1.2, Place::kUnobserved, 0.05);
    const std::size_t moving = followed.step(scene);
    const bool found_when_it_must = k < 6 || moving == scene.judged.points.size();
    const bool not_before_it_can = k > 3 || moving == 0;
    EXPECT_TRUE(found_when_it_must && not_before_it_can) << "scan " << k << ": " << moving;
  }
  ASSERT_EQ(followed.tracker.objects().size(), 1U);
  EXPECT_NEAR(followed.tracker.objects()[0].velocity.x(), 12.0, 0.2);
}

TEST(ProofsOfMotion, WithoutMotionOnlyNewEchoesTell) {
  ObjectConfig config;
  config.motion = false;
  for (const Place place : {Place::kUnobserved, Place::kNew}) {
    Followed followed(config);
    for (int k = 0; k < 30; ++k) {
      JudgedScene scene(0.1 * k, 1.2 * k);
      scene.face({1.2 * k + 12.0, -0.9, 0.3}, {0.0, 1.8, 0.0}, 1.2, place, 0.05);
      EXPECT_EQ(followed.step(scene), place == Place::kNew ? scene.judged.points.size() : 0U) << "scan " << k;
    }
  }
}

TEST(ProofsOfMotion, AFewNewEchoesAndAPlaceThatIsLeftAreEnough) {
  // The ends of a long vehicle that passes by: little is new, the former end is seen free.
  Followed followed;
  std::size_t moving = 0;
  for (int k = 0; k < 20; ++k) {
    JudgedScene scene(0.1 * k);
    const double x = -10.0 + 0.8 * k;
    scene.face({x, 6.0, 0.3}, {12.0, 0.0, 0.0}, 1.2, Place::kUnobserved);
    scene.face({-30.0, 20.0, 0.3}, {60.0, 0.0, 0.0}, 6.0, Place::kUnobserved, 0.15);  // a house behind
    for (int i = 0; i < 6; ++i) scene.echo({x + 12.1, 6.0, 0.3 + 0.1 * i}, Place::kNew);
    moving = followed.step(scene);
  }
  EXPECT_EQ(moving, 121U * 13U + 6U);
}

TEST(ProofsOfMotion, WhatStandsNeverMovesHoweverTheSensorPassesIt) {
  for (const Place place : {Place::kUnobserved, Place::kSettled}) {
    Followed followed;
    for (int k = 0; k < 40; ++k) {
      JudgedScene scene(0.1 * k, 1.0 * k);
      addVehicle(scene, 20.0, 3.0, place);
      scene.face({30.0, -6.0, 0.3}, {0.0, 2.0, 0.0}, 1.5, place);
      scene.face({-20.0, 12.0, 0.0}, {100.0, 0.0, 0.0}, 6.0, place, 0.2);
      EXPECT_EQ(followed.step(scene), 0U) << "scan " << k;
      EXPECT_TRUE(followed.tracker.objects().empty());
    }
  }
}

/// Eight things that stand around the sensor, each with two sides, as poses that are off by (x, y) show them.
void addSurroundings(JudgedScene& scene, double x, double y) {
  for (const double side : {-1.0, 1.0}) {
    for (const double along : {6.0, 12.0, 18.0, 24.0}) {
      scene.face({along + x, side * 6.0 + y, 0.3}, {0.0, side * 1.5, 0.0}, 1.2, Place::kSettled, 0.05);
      scene.face({along + x, side * 6.0 + y, 0.3}, {1.5, 0.0, 0.0}, 1.2, Place::kSettled, 0.05);
    }
  }
}

TEST(ProofsOfMotion, WhatCreepsIsFoundThoughItIsSettledOrMixed) {
  for (const std::size_t new_echoes : {0U, 6U}) {
    Followed followed;
    for (int k = 0; k < 30; ++k) {
      JudgedScene scene(0.1 * k);
      addSurroundings(scene, 0.0, 0.0);
      const std::size_t standing = scene.judged.points.size();
      scene.face({12.0 - 0.04 * std::max(k - 10, 0), -0.9, 0.3}, {0.0, 1.8, 0.0}, 1.2, Place::kSettled, 0.05);
      for (std::size_t i = 0; k > 10 && i < new_echoes; ++i) scene.judged.places[standing + i] = Place::kNew;
      const std::size_t moving = followed.step(scene);
      const std::size_t all = scene.judged.points.size() - standing;
      const bool must = k >= 16, may = k > 13;  // 0.2 m closer, twice
      EXPECT_TRUE(moving == all ? may : !must && moving <= new_echoes)
          << "scan " << k << ": " << moving << " of " << all;
      EXPECT_LE(followed.tracker.objects().size(), 1U) << "what is mixed is no object";
    }
  }
}

TEST(ProofsOfMotion, PosesThatAreOffMoveNothing) {
  Followed followed;
  for (int k = 0; k < 30; ++k) {
    JudgedScene scene(0.1 * k);
    addSurroundings(scene, 0.15 * std::sin(1.7 * k), 0.2 * std::sin(2.9 * k));
    EXPECT_EQ(followed.step(scene), 0U) << "scan " << k;
  }
}

TEST(ProofsOfMotion, APlumeIsNoObject) {
  Followed followed;
  for (int k = 0; k < 10; ++k) {
    JudgedScene scene(0.1 * k);
    addVehicle(scene, 5.0 + 0.5 * k, 2.0, Place::kNew);
    EXPECT_EQ(followed.step(scene, 0, true), 0U) << "scan " << k;
  }
}

TEST(ProofsOfMotion, AStripOfAWallThatIsSeenThroughAGapProvesNothingByItsShape) {
  for (const double width : {0.1, 0.5}) {
    Followed followed;
    std::size_t moving = 0;
    for (int k = 0; k < 20; ++k) {
      JudgedScene scene(0.1 * k);
      scene.face({8.0, -4.0 + 0.05 * k, 0.4}, {0.0, width, 0.0}, 1.6, Place::kUnobserved, 0.05);
      scene.face({8.42, -8.0, 0.0}, {0.0, 16.0, 0.0}, 4.0, Place::kSettled, 0.1);
      moving += followed.step(scene);
    }
    EXPECT_EQ(moving > 0, width > 0.25) << width << " m";
  }
}

TEST(ProofsOfMotion, WhatStopsStaysDynamicForTheStopTime) {
  for (const double stop_time : {0.0, 0.45, 1.05}) {
    ObjectConfig config;
    config.motion = false;  // its places alone tell
    config.stop_time = stop_time;
    Followed followed(config);
    for (int k = 0; k < 25; ++k) {
      JudgedScene scene(0.1 * k);
      addVehicle(scene, 8.0 + 0.3 * std::min(k, 9), 2.0, k < 10 ? Place::kNew : Place::kUnobserved);
      scene.echo({10.7, 2.0, 0.8}, Place::kNew);  // no proof by itself
      const bool expected = 0.1 * (k - 9) <= stop_time;
      EXPECT_EQ(followed.step(scene) > 0, expected) << "scan " << k << " stop_time " << stop_time;
      ASSERT_EQ(followed.tracker.objects().size(), 1U) << "it has moved since it is followed";
      EXPECT_EQ(followed.tracker.objects()[0].dynamic, expected);
    }
  }
}

TEST(ProofsOfMotion, WhatHasNoFreshEchoLeftHasNotJustStoppedUnlessItMovedAsAWhole) {
  // What a door uncovered that has just closed, and a vehicle that has just stopped.
  for (const bool moves_whole : {false, true}) {
    ObjectConfig config;
    config.motion = moves_whole;
    Followed followed(config);
    std::size_t moving = 0;
    for (int k = 0; k < 18; ++k) {
      JudgedScene scene(0.1 * k);
      addVehicle(scene, 8.0 + 0.5 * std::min(k, 9), 2.0, k < 10 ? Place::kNew : Place::kUnobserved);
      if (k >= 10) scene.echo({12.5, 2.0, 0.8}, Place::kLingering);
      scene.face({20.0, -2.0, 0.0}, {0.0, 8.0, 0.0}, 3.0, Place::kSettled, 0.1);  // seen where it has left
      moving += followed.step(scene);
      if (k < (moves_whole ? 14 : 10)) continue;  // until then its former places, or its new echoes, tell
      ASSERT_EQ(followed.verdicts.size(), 2U) << "the vehicle, and the wall";
      EXPECT_EQ(followed.verdicts[0].proof, moves_whole ? Proof::kMovedBefore : Proof::kNone) << "scan " << k;
    }
    EXPECT_GT(moving, 0U);
  }
}

TEST(ProofsOfMotion, WhatRestsHasStoppedHoweverNewItsPlaceIs) {
  const ObjectConfig config;
  const TrackerOptions options;
  Followed followed(config);
  for (int k = 0; k < 25; ++k) {
    JudgedScene scene(0.1 * k);
    const int braked = std::min(k, 5);
    addVehicle(scene, 8.0 + 0.5 * braked, 2.0, Place::kNew);
    const double resting = 0.1 * (k - 5), stops = options.rests_after + config.stop_time;
    const std::size_t moving = followed.step(scene);
    if (resting < stops - 0.09) {
      EXPECT_GT(moving, 0U) << "scan " << k;
    } else if (resting > stops + 0.01) {
      EXPECT_EQ(moving, 0U) << "scan " << k;
    }
  }
}

TEST(ProofsOfMotion, AParkedCarThatDrivesOffIsFoundBeforeItIsFast) {
  Followed followed;
  for (int k = 0; k < 45; ++k) {
    JudgedScene scene(0.1 * k);
    const double driving = std::max(0.0, 0.1 * (k - 20)), way = 0.5 * 1.75 * driving * driving;
    addVehicle(scene, 8.0 + way, 2.0, way < 0.2 ? Place::kSettled : Place::kUnobserved);
    const std::size_t car = scene.judged.points.size();
    scene.face({-10.0, 12.0, 0.0}, {60.0, 0.0, 0.0}, 6.0, Place::kSettled, 0.2);
    const std::size_t moving = followed.step(scene);
    EXPECT_TRUE(moving == 0 || moving == car) << "scan " << k << ": " << moving;
    EXPECT_EQ(moving, driving > 1.5 ? car : driving < 0.3 ? 0U : moving) << "driving for " << driving << " s";
  }
}

TEST(ProofsOfMotion, WhatSettlesStandsAtOnce) {
  Followed followed;
  for (int k = 0; k < 14; ++k) {
    JudgedScene scene(0.1 * k);
    addVehicle(scene, 8.0 + 0.3 * std::min(k, 9), 2.0, k < 10 ? Place::kNew : Place::kSettled);
    EXPECT_EQ(followed.step(scene) > 0, k < 10) << "scan " << k;
  }
}

TEST(ProofsOfMotion, WhatASlowThingLeavesBehindAFenceTells) {
  // Careful sight knows nothing behind a fence; the object's own shape, found elsewhere, tells.
  Followed followed;
  std::size_t moving = 0, person = 0;
  for (int k = 0; k < 20; ++k) {
    JudgedScene scene(0.1 * k);
    const double y = -3.0 + 0.12 * k;
    scene.face({9.0, y, 0.4}, {0.0, 0.5, 0.0}, 1.4, Place::kUnobserved, 0.05);
    person = scene.judged.points.size();
    for (int picket = 0; picket < 40; ++picket) {
      scene.face({6.0, -4.0 + 0.2 * picket, 0.0}, {0.0, 0.02, 0.0}, 1.1, Place::kSettled, 0.02);
    }
    scene.face({25.0, -15.0, 0.0}, {0.0, 30.0, 0.0}, 5.0, Place::kSettled);
    moving = followed.step(scene);
  }
  EXPECT_EQ(moving, person);
}

TEST(ProofsOfMotion, AThinThingNeverMoves) {
  Followed followed;
  for (int k = 0; k < 10; ++k) {
    JudgedScene scene(0.1 * k);
    scene.face({8.0 + 0.5 * k, 2.0, 2.2}, {0.0, 1.5, 0.0}, 0.05, Place::kNew, 0.05);
    EXPECT_EQ(followed.step(scene), 0U);
  }
}

TEST(ProofsOfMotion, APoleThatScansMissedHasNotEntered) {
  for (const double width : {0.1, 0.5}) {
    Followed followed;
    JudgedScene scene(0.0);
    scene.face({10.0, 2.0, 0.5}, {0.0, width, 0.0}, 1.5, Place::kSurelyNew);
    EXPECT_EQ(followed.step(scene) > 0, width > 0.3) << width;
  }
}

/// A face of 99 new echoes of which so many do not linger.
std::size_t movingOf(std::size_t fresh, int min_echoes) {
  ObjectConfig config;
  config.min_echoes = min_echoes;
  Followed followed(config);
  JudgedScene scene(0.0);
  scene.face({10.0, 2.0, 0.5}, {0.0, 0.8, 0.0}, 1.0, both(Place::kSurelyNew, Place::kLingering));
  for (std::size_t i = 0; i < fresh; ++i) scene.judged.places[9 * i % 99] = Place::kSurelyNew;
  return followed.step(scene);
}

TEST(ProofsOfMotion, WhatHitsNoFreshPlacesStandsThereHoweverNewTheyAre) {
  EXPECT_EQ(movingOf(0, 5), 0U);
  EXPECT_EQ(movingOf(9, 5), 0U) << "not a tenth of them";
  EXPECT_EQ(movingOf(10, 5), 99U);
  EXPECT_EQ(movingOf(10, 11), 0U) << "fewer than min_echoes";
}

/// Proof of what drives ahead of the sensor at its speed, so many metres away, of this width and height.
Proof proofAhead(double away, double bottom, double width, double height) {
  Followed followed;
  for (int k = 0; k < 10; ++k) {
    JudgedScene scene(0.1 * k, 1.2 * k);
    scene.face({1.2 * k + away, -0.5 * width, bottom}, {0.0, width, 0.0}, height, Place::kUnobserved, 0.05);
    followed.step(scene);
  }
  return followed.verdicts.empty() ? Proof::kNone : followed.verdicts[0].proof;
}

TEST(ProofsOfMotion, ARailOrOneBeamHighUpIsNotProvenByItsRear) {
  EXPECT_EQ(proofAhead(12.0, 0.3, 1.8, 1.2), Proof::kRearReceded);
  EXPECT_NE(proofAhead(12.0, 0.3, 4.0, 0.5), Proof::kRearReceded);
  EXPECT_NE(proofAhead(30.0, 0.85, 1.8, 0.1), Proof::kRearReceded);
  EXPECT_EQ(proofAhead(12.0, 0.3, 2.5, 0.5), Proof::kRearReceded) << "shorter than a rail";
  EXPECT_EQ(proofAhead(30.0, 0.7, 1.8, 0.1), Proof::kRearReceded) << "lower";
}

TEST(ProofsOfMotion, WhatIsNoLongerMixedGoesOnWithItsPart) {
  // Too few echoes to be told as displaced: its part that is not settled proves for itself.
  Followed followed;
  for (int k = 0; k <= 10; ++k) {
    JudgedScene scene(0.1 * k);
    scene.face({8.0 + 0.5 * k, 2.0, 0.3}, {0.0, 0.75, 0.0}, 1.0, k < 10 ? Place::kSettled : Place::kUnobserved, 0.25);
    scene.face({8.0 + 0.5 * k, 3.0, 0.3}, {0.0, 1.0, 0.0}, 1.0, Place::kUnobserved, 0.25);
    const std::size_t all = scene.judged.points.size();
    for (std::size_t i = 0; k < 10 && i < 6; ++i) scene.judged.places[all - 1 - i] = Place::kNew;
    scene.face({30.0, -5.0, 0.0}, {0.0, 20.0, 0.0}, 4.0, Place::kSettled, 0.2);  // seen where it has left
    followed.step(scene);
    const bool is_mixed = followed.segments[0].is_mixed;
    EXPECT_EQ(is_mixed, k < 10) << "scan " << k;
    if (is_mixed) {
      EXPECT_EQ(followed.verdicts[0].proof, Proof::kNone);
      EXPECT_EQ(followed.verdicts[0].object, 0U) << "it is no object";
    }
  }
  EXPECT_TRUE(followed.verdicts[0].moves());
}

TEST(ProofsOfMotion, WhatMovedAndIsMixedNowIsNoObjectMeanwhile) {
  Followed followed;
  for (int k = 0; k <= 10; ++k) {
    JudgedScene scene(0.1 * k);
    addVehicle(scene, 8.0 + 0.1 * k, 2.0, k < 10 ? Place::kNew : Place::kSettled);
    const std::size_t all = scene.judged.points.size();
    for (std::size_t i = 0; k == 10 && i < 6; ++i) scene.judged.places[all - 1 - i] = Place::kNew;
    followed.step(scene);
    if (k < 10) {
      EXPECT_EQ(followed.tracker.objects().size(), 1U);
    }
  }
  ASSERT_TRUE(followed.segments[0].is_mixed);
  for (const Object& object : followed.tracker.objects()) EXPECT_LE(object.echoes, 6U);
}

}  // namespace
}  // namespace donex
