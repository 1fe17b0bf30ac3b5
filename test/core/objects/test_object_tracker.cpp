// Objects followed over time: who they are.
#include <array>

#include <gtest/gtest.h>

#include "core/objects/followed.h"

namespace donex {
namespace {

using testing::addVehicle;
using testing::Followed;
using testing::JudgedScene;

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
