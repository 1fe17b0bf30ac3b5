// Objects followed over time: which of them move, and who they are.
#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "core/objects/object_tracker.h"
#include "core/objects/segmenter.h"
#include "support/judged_scene.h"

namespace donex {
namespace {

using testing::JudgedScene;

const SightImage::Reading kReading{true, 0.038};

/// What the detector does with a judged scan.
class Followed {
 public:
  explicit Followed(const ObjectConfig& config = {}) : segmenter_(60.0, config), tracker(config) {}

  /// Number of the scan's echoes that move. `goes_on_with`: what the first segment's echoes beside belong to;
  /// `is_plume`: all of them are.
  std::size_t step(const JudgedScene& scene, std::uint32_t goes_on_with = 0, bool is_plume = false) {
    history_.arrive(scene.scan(), scene.judged.is_echo);
    history_.add(scene.scan(), scene.judged.is_echo);
    tracker.predict(scene.judged, predictions_);
    segmenter_.connect(scene.judged);
    segmenter_.segment(scene.judged, predictions_, segments);
    if (goes_on_with != 0) segments[0].object = goes_on_with;
    for (Segment& segment : segments) segment.is_of_plume = is_plume;
    tracker.update(scene.judged, segments, predictions_, history_.newestSeenFrom(scene.judged.odom_from_points),
                   verdicts);
    tracker.describe(scene.judged, segments);
    std::size_t moving = 0;
    for (std::size_t i = 0; i < segments.size(); ++i) moving += verdicts[i].moves() ? segments[i].echoes.size() : 0U;
    return moving;
  }

 private:
  SightHistory history_{2.0, 0.0, 0.5F, kReading};
  Segmenter segmenter_;
  Predictions predictions_;

 public:
  ObjectTracker tracker;
  Segments segments;
  Verdicts verdicts;
};

/// The rear and a side of a vehicle whose rear is at x.
void addVehicle(JudgedScene& scene, double x, double y, Place place) {
  scene.face({x, y, 0.3}, {0.0, 1.8, 0.0}, 1.2, place, 0.05);
  scene.face({x, y, 0.3}, {4.0, 0.0, 0.0}, 1.2, place, 0.05);
}

TEST(ObjectTracker, SomethingNewIsFollowedUnderOneNumber) {
  Followed followed;
  std::uint32_t id = 0;
  for (int k = 0; k < 20; ++k) {
    JudgedScene scene(0.1 * k);
    addVehicle(scene, 5.0 + 0.8 * k, 2.0, Place::kNew);
    EXPECT_EQ(followed.step(scene), scene.judged.points.size());
    ASSERT_EQ(followed.tracker.objects().size(), 1U);
    const Object& object = followed.tracker.objects()[0];
    id = k == 0 ? object.id : id;
    EXPECT_EQ(object.id, id) << "scan " << k;
    EXPECT_TRUE(object.dynamic);
    EXPECT_NEAR(object.age, 0.1 * k, 1e-9);
    EXPECT_EQ(object.echoes, scene.judged.points.size());
    EXPECT_NEAR(object.odom_from_box.translation().x(), 7.0 + 0.8 * k, 0.4);
    if (k == 0) continue;  // the direction is not known yet
    EXPECT_NEAR(object.size.x(), 4.0, 0.1);
    EXPECT_NEAR(object.velocity.x(), 8.0, 0.1);
    EXPECT_NEAR(object.velocity.y(), 0.0, 0.1);
  }
}

TEST(ObjectTracker, TwoThatPassEachOtherKeepTheirNumbers) {
  Followed followed;
  std::array<std::uint32_t, 2> ids{};
  for (int k = 0; k < 20; ++k) {
    JudgedScene scene(0.1 * k);
    addVehicle(scene, 4.0 + 1.0 * k, 2.0, Place::kNew);
    addVehicle(scene, 24.0 - 1.0 * k, 6.0, Place::kNew);
    followed.step(scene);
    ASSERT_EQ(followed.tracker.objects().size(), 2U) << "scan " << k;
    for (std::size_t i = 0; i < 2; ++i) {
      if (k == 0) ids[i] = followed.tracker.objects()[i].id;
      EXPECT_EQ(followed.tracker.objects()[i].id, ids[i]) << "scan " << k;
    }
  }
  EXPECT_NE(ids[0], ids[1]);
}

TEST(ObjectTracker, APartThatFitsAnotherTrackLeavesItsOwn) {
  Followed followed;
  JudgedScene first(0.0);
  addVehicle(first, 5.0, 2.0, Place::kNew);
  addVehicle(first, 5.0, 8.0, Place::kNew);
  followed.step(first);
  ASSERT_EQ(followed.verdicts.size(), 2U);
  const std::uint32_t other = followed.verdicts[0].object, own = followed.verdicts[1].object;
  // Seen once so far, and said to go on where the second vehicle is.
  JudgedScene second(0.1);
  addVehicle(second, 5.2, 8.0, Place::kNew);
  followed.step(second, other);
  ASSERT_EQ(followed.verdicts.size(), 1U);
  EXPECT_EQ(followed.verdicts[0].object, own);
  JudgedScene third(0.2);
  addVehicle(third, 5.4, 2.0, Place::kNew);
  followed.step(third);
  EXPECT_EQ(followed.verdicts[0].object, other) << "it is followed still";
}

TEST(ObjectTracker, WithMoreOfItInViewATurnIsJudgedAnew) {
  Followed followed;
  JudgedScene before(0.0);
  addVehicle(before, 5.0, 2.0, Place::kNew);
  followed.step(before);
  const std::uint32_t id = followed.verdicts[0].object;
  JudgedScene half(0.1);
  half.face({5.8, 2.0, 0.3}, {2.0, 0.0, 0.0}, 1.2, Place::kNew, 0.05);
  followed.step(half);
  JudgedScene whole(0.11);
  whole.judged.continues_turn = true;
  addVehicle(whole, 5.8, 2.0, Place::kNew);
  followed.step(whole, id);
  ASSERT_EQ(followed.tracker.objects().size(), 1U);
  EXPECT_EQ(followed.tracker.objects()[0].id, id);
  EXPECT_NEAR(followed.tracker.objects()[0].velocity.x(), 0.8 / 0.11, 0.3)
      << "since the turn before, not since the half";
}

TEST(ObjectTracker, AVehicleAheadAtTheSameSpeedIsFoundByItsRear) {
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

TEST(ObjectTracker, WithoutMotionOnlyNewEchoesTell) {
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

TEST(ObjectTracker, AFewNewEchoesAndAPlaceThatIsLeftAreEnough) {
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

TEST(ObjectTracker, WhatStandsNeverMovesHoweverTheSensorPassesIt) {
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

TEST(ObjectTracker, WhatCreepsIsFoundThoughAllOfItIsSettled) {
  Followed followed;
  for (int k = 0; k < 30; ++k) {
    JudgedScene scene(0.1 * k);
    addSurroundings(scene, 0.0, 0.0);
    const std::size_t standing = scene.judged.points.size();
    scene.face({12.0 - 0.04 * std::max(k - 10, 0), -0.9, 0.3}, {0.0, 1.8, 0.0}, 1.2, Place::kSettled, 0.05);
    const std::size_t moving = followed.step(scene);
    const bool expected = k >= 16;  // 0.2 m closer, twice
    EXPECT_EQ(moving, expected || (k > 13 && moving > 0) ? scene.judged.points.size() - standing : 0U) << "scan " << k;
  }
}

TEST(ObjectTracker, PosesThatAreOffMoveNothing) {
  Followed followed;
  for (int k = 0; k < 30; ++k) {
    JudgedScene scene(0.1 * k);
    addSurroundings(scene, 0.15 * std::sin(1.7 * k), 0.2 * std::sin(2.9 * k));
    EXPECT_EQ(followed.step(scene), 0U) << "scan " << k;
  }
}

TEST(ObjectTracker, APlumeIsNoObject) {
  Followed followed;
  for (int k = 0; k < 10; ++k) {
    JudgedScene scene(0.1 * k);
    addVehicle(scene, 5.0 + 0.5 * k, 2.0, Place::kNew);
    EXPECT_EQ(followed.step(scene, 0, true), 0U) << "scan " << k;
  }
}

TEST(ObjectTracker, AStripOfAWallThatIsSeenThroughAGapProvesNothingByItsShape) {
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

TEST(ObjectTracker, WhatStopsStaysDynamicForTheStopTime) {
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

TEST(ObjectTracker, WhatHasNoNewEchoLeftHasNotJustStoppedUnlessItMovedAsAWhole) {
  // A car behind the door that has just closed, and a vehicle that drives into what it hid itself.
  for (const bool moves_whole : {false, true}) {
    ObjectConfig config;
    config.motion = moves_whole;
    Followed followed(config);
    std::size_t moving = 0, moving_on = 0;
    for (int k = 0; k < 12; ++k) {
      JudgedScene scene(0.1 * k);
      addVehicle(scene, 8.0 + 0.5 * std::min(k, 9), 2.0, k < 10 ? Place::kNew : Place::kUnobserved);
      scene.face({20.0, -2.0, 0.0}, {0.0, 8.0, 0.0}, 3.0, Place::kSettled, 0.1);  // seen where it has left
      (k < 10 ? moving : moving_on) += followed.step(scene);
    }
    EXPECT_GT(moving, 0U);
    EXPECT_EQ(moving_on > 0, moves_whole);
  }
}

TEST(ObjectTracker, WhatRestsHasStoppedHoweverNewItsPlaceIs) {
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

TEST(ObjectTracker, AParkedCarThatDrivesOffIsFoundBeforeItIsFast) {
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

TEST(ObjectTracker, WhatSettlesStandsAtOnce) {
  Followed followed;
  for (int k = 0; k < 14; ++k) {
    JudgedScene scene(0.1 * k);
    addVehicle(scene, 8.0 + 0.3 * std::min(k, 9), 2.0, k < 10 ? Place::kNew : Place::kSettled);
    EXPECT_EQ(followed.step(scene) > 0, k < 10) << "scan " << k;
  }
}

TEST(ObjectTracker, WhatASlowThingLeavesBehindAFenceTells) {
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

TEST(ObjectTracker, FragmentsOfAVehicleBehindAPoleMoveWithIt) {
  Followed followed;
  for (int k = 0; k < 15; ++k) {
    JudgedScene scene(0.1 * k);
    const double x = 12.0 + 0.6 * k;
    scene.face({x, -0.9, 0.3}, {0.0, 1.8, 0.0}, 1.2, Place::kUnobserved, 0.05);
    const bool is_hidden_in_part = k == 14;
    scene.face({x, -0.9, 0.3}, {is_hidden_in_part ? 2.0 : 4.0, 0.0, 0.0}, 1.2, Place::kUnobserved, 0.05);
    // Seven echoes beyond a gap that connects nothing.
    if (is_hidden_in_part) scene.face({x + 3.7, -0.9, 0.3}, {0.0, 0.05, 0.0}, 0.3, Place::kUnobserved, 0.05);
    const std::size_t moving = followed.step(scene);
    const bool is_known = k > 8;
    EXPECT_TRUE(!is_known || moving == scene.judged.points.size()) << "scan " << k << ": " << moving;
  }
  EXPECT_EQ(followed.segments.size(), 2U);
}

TEST(ObjectTracker, AThinThingNeverMoves) {
  Followed followed;
  for (int k = 0; k < 10; ++k) {
    JudgedScene scene(0.1 * k);
    scene.face({8.0 + 0.5 * k, 2.0, 2.2}, {0.0, 1.5, 0.0}, 0.05, Place::kNew, 0.05);
    EXPECT_EQ(followed.step(scene), 0U);
  }
}

TEST(ObjectTracker, APoleThatScansMissedHasNotEntered) {
  for (const double width : {0.1, 0.5}) {
    Followed followed;
    JudgedScene scene(0.0);
    scene.face({10.0, 2.0, 0.5}, {0.0, width, 0.0}, 1.5, Place::kSurelyNew);
    EXPECT_EQ(followed.step(scene) > 0, width > 0.3) << width;
  }
}

TEST(ObjectTracker, WhatIsLongerThanAnyVehicleIsNotFollowed) {
  for (const double length : {24.0, 26.0}) {
    Followed followed;
    JudgedScene scene(0.0);
    scene.face({-12.0, 6.0, 0.3}, {length, 0.0, 0.0}, 1.2, Place::kNew, 0.1);
    EXPECT_EQ(followed.step(scene) > 0, length < 25.0);
    EXPECT_EQ(followed.tracker.objects().size(), length < 25.0 ? 1U : 0U);
  }
}

TEST(ObjectTracker, NumbersEndWithTheThingAndAreNotUsedAgain) {
  Followed followed;
  const auto seeAt = [&](double stamp) {
    JudgedScene scene(stamp);
    addVehicle(scene, 8.0, 2.0, Place::kNew);
    followed.step(scene);
    return followed.tracker.objects().at(0).id;
  };
  const std::uint32_t first = seeAt(0.0);
  followed.step(JudgedScene(0.25));
  EXPECT_TRUE(followed.tracker.objects().empty());
  EXPECT_EQ(seeAt(0.5), first) << "hidden for a moment";
  followed.step(JudgedScene(1.0));
  followed.step(JudgedScene(1.25));
  const std::uint32_t second = seeAt(1.5);
  EXPECT_GT(second, first) << "forgotten in between";
  followed.tracker.reset();
  EXPECT_TRUE(followed.tracker.objects().empty());
}

TEST(ObjectTracker, MemoryIsBounded) {
  Followed followed;
  std::size_t after_a_while = 0;
  for (int k = 0; k < 400; ++k) {
    JudgedScene scene(0.1 * k);
    scene.face({5.0 + 3.0 * (k % 9), 2.0, 0.3}, {0.0, 1.8, 0.0}, 1.2, Place::kNew);
    followed.step(scene);
    if (k == 100) after_a_while = followed.tracker.memoryBytes();
  }
  EXPECT_GT(after_a_while, 0U);
  EXPECT_LE(followed.tracker.memoryBytes(), 2 * after_a_while);
}

}  // namespace
}  // namespace donex
