// Which connected echoes are one object, and which of them only stand close to it.
#include <algorithm>

#include <gtest/gtest.h>

#include "core/objects/segmenter.h"
#include "core/objects/trimmer.h"
#include "support/judged_scene.h"

namespace donex {
namespace {

using testing::JudgedScene;

constexpr double kReach = 40.0;

Segments foundWithMixed(const JudgedScene& scene, const Predictions& predictions = {}) {
  Segmenter segmenter(kReach, ObjectConfig{});
  Segments segments;
  segmenter.connect(scene.judged);
  segmenter.segment(scene.judged, predictions, segments);
  return segments;
}

/// Each echo in one segment at most.
Segments found(const JudgedScene& scene, const Predictions& predictions = {}) {
  Segments segments = foundWithMixed(scene, predictions);
  segments.removeIf([](const Segment& segment) { return segment.is_mixed; });
  return segments;
}

TEST(Segmenter, TellsOfEachThingWhatItsEchoesSay) {
  JudgedScene scene(0.0);
  scene.face({6.0, 1.0, 0.5}, {0.0, 1.0, 0.0}, 1.0, Place::kNew);          // 11 x 11
  scene.face({6.0, -4.0, 0.5}, {0.0, 0.5, 0.0}, 1.0, Place::kSettled);     // 6 x 11
  scene.face({-6.0, 0.0, 0.5}, {0.0, 0.2, 0.0}, 0.2, Place::kUnobserved);  // 3 x 3
  scene.judged.odom_from_points.translation() << 100.0, 0.0, 0.0;
  const Segments segments = found(scene);
  ASSERT_EQ(segments.size(), 3U);
  EXPECT_EQ(segments[0].echoes.size(), 121U);
  EXPECT_EQ(segments[0].new_echoes, 121);
  EXPECT_EQ(segments[0].settled_echoes, 0);
  EXPECT_TRUE(segments[0].center().isApprox(Eigen::Vector3d(106.0, 1.5, 1.0), 1e-4)) << segments[0].center();
  EXPECT_NEAR(segments[0].extent().y(), 1.0, 1e-4);
  EXPECT_EQ(segments[1].settled_echoes, 66);
  EXPECT_EQ(segments[1].new_echoes, 0);
  EXPECT_EQ(segments[2].echoes.size(), 9U);
  EXPECT_EQ(segments[2].new_echoes + segments[2].settled_echoes, 0);
}

TEST(Segmenter, TooFewEchoesAreNoThing) {
  for (const int echoes : {4, 5}) {
    JudgedScene scene(0.0);
    for (int i = 0; i < echoes; ++i) scene.echo({6.0, 0.1 * i, 1.0}, Place::kNew);
    EXPECT_EQ(found(scene).size(), echoes < ObjectConfig{}.min_echoes ? 0U : 1U);
  }
}

TEST(Segmenter, EchoesABeamApartAreOneThing) {
  JudgedScene scene(0.0);
  for (const double height : {0.4, 1.1}) {
    for (int i = 0; i < 6; ++i) scene.echo({20.0, 0.1 * i, height}, Place::kNew);
  }
  EXPECT_EQ(found(scene).size(), 2U);
  scene.judged.beams_apart = 0.036;  // 0.7 m there
  EXPECT_EQ(found(scene).size(), 1U);
}

TEST(Segmenter, IsNewWhereEnoughIsNew) {
  const ObjectConfig config;  // at least 5, more than 0.4 of new and settled, more than 0.15 of all
  const auto isNewOf = [&](int fresh, int settled, std::size_t all, double length = 4.0, int surely = -1) {
    Segment segment;
    segment.new_echoes = fresh;
    segment.surely_new_echoes = surely < 0 ? fresh : surely;
    segment.settled_echoes = settled;
    segment.echoes.resize(all);
    segment.high = Eigen::Vector3d(length, 1.0, 1.0);
    return SegmentRules(config).isNew(segment);
  };
  EXPECT_TRUE(isNewOf(5, 0, 10));
  EXPECT_FALSE(isNewOf(4, 0, 4));
  EXPECT_TRUE(isNewOf(41, 59, 100));
  EXPECT_FALSE(isNewOf(39, 61, 100));
  EXPECT_TRUE(isNewOf(16, 0, 100));
  EXPECT_FALSE(isNewOf(14, 0, 100));
  EXPECT_TRUE(isNewOf(50, 0, 100, 24.0));
  EXPECT_FALSE(isNewOf(50, 0, 100, 26.0)) << "longer than any vehicle";
  EXPECT_FALSE(isNewOf(49, 0, 100, 4.0, 0)) << "hardly surely new: half of it must be new";
  EXPECT_TRUE(isNewOf(50, 0, 100, 4.0, 0));
}

TEST(Segmenter, WhatMayHaveStoodBetweenBeamsIsNotNew) {
  const auto isNewOf = [](double height, int coarsely) {
    Segment segment;
    segment.new_echoes = segment.surely_new_echoes = 40;
    segment.coarsely_new_echoes = coarsely;
    segment.echoes.resize(40);
    segment.high = Eigen::Vector3d(4.0, 0.1, height);
    return SegmentRules(ObjectConfig{}).isNew(segment);
  };
  EXPECT_TRUE(isNewOf(0.3, 20));
  EXPECT_FALSE(isNewOf(0.3, 21)) << "a guard rail";
  EXPECT_TRUE(isNewOf(0.6, 40)) << "too high to be missed";
}

TEST(Segmenter, APedestrianAtAWallIsOnlyHimself) {
  JudgedScene scene(0.0);
  scene.face({10.0, -8.0, 0.3}, {0.0, 16.0, 0.0}, 2.0, Place::kSettled);
  const std::size_t wall = scene.judged.points.size();
  scene.face({9.8, 1.0, 0.3}, {0.0, 0.4, 0.0}, 1.5, Place::kNew);
  const std::size_t pedestrian = scene.judged.points.size() - wall;
  const Segments segments = found(scene);
  ASSERT_EQ(segments.size(), 1U);
  EXPECT_EQ(segments[0].echoes.size(), pedestrian);
  EXPECT_EQ(segments[0].echoes.front(), wall);
  EXPECT_TRUE(SegmentRules(ObjectConfig{}).isNew(segments[0]));
}

TEST(Segmenter, WhatIsMixedStaysAsWellIfItMayBeOneThing) {
  for (const double length : {1.0, 2.0, 20.0, 26.0}) {
    JudgedScene scene(0.0);
    scene.face({10.0, -13.0, 0.3}, {0.0, length, 0.0}, 2.0, Place::kSettled);
    const std::size_t settled = scene.judged.points.size();
    scene.face({9.8, -13.0, 0.3}, {0.0, 0.4, 0.0}, 1.5, Place::kNew);
    const Segments segments = foundWithMixed(scene);
    const bool may_be_one = length > 1.75 && length < 25.0;
    ASSERT_EQ(segments.size(), may_be_one ? 2U : 1U) << length;
    EXPECT_EQ(segments[0].is_mixed, may_be_one);
    if (may_be_one) {
      EXPECT_EQ(segments[0].echoes.size(), scene.judged.points.size());
    }
    const Segment& apart = segments[segments.size() - 1];
    EXPECT_FALSE(apart.is_mixed);
    EXPECT_EQ(apart.echoes.size(), scene.judged.points.size() - settled);
  }
}

TEST(Segmenter, WhatWasSeenElsewhereIsOneThoughItsSideIsSettled) {
  // A car that creeps: its front is new, its side settles as it slides along itself.
  JudgedScene scene(0.0);
  scene.face({8.0, 2.0, 0.3}, {0.0, 1.8, 0.0}, 1.2, Place::kNew);
  scene.face({8.0, 2.0, 0.3}, {4.5, 0.0, 0.0}, 1.2, Place::kSettled);
  const std::size_t all = scene.judged.points.size();
  Prediction car;
  car.center = Eigen::Vector3d(10.3, 2.9, 0.9);
  car.extent = car.full_extent = Eigen::Vector3d(4.5, 1.8, 1.2);
  for (const bool is_displaced : {false, true}) {
    for (const bool is_proven : {false, true}) {
      car.is_displaced = is_displaced;
      car.is_proven = is_proven;
      const Segments segments = found(scene, {car});
      ASSERT_EQ(segments.size(), 1U);
      EXPECT_EQ(segments[0].echoes.size() == all, is_displaced);
    }
  }
}

TEST(Segmenter, TwoPedestriansAtAWallAreTwoWithWhatIsUnobservedOfThem) {
  JudgedScene scene(0.0);
  scene.face({10.0, -8.0, 0.3}, {0.0, 16.0, 0.0}, 2.0, Place::kSettled);
  for (const double y : {-4.0, 3.0}) {
    scene.face({9.8, y, 0.3}, {0.0, 0.4, 0.0}, 1.0, Place::kNew);
    scene.face({9.8, y, 1.4}, {0.0, 0.4, 0.0}, 0.3, Place::kUnobserved);
  }
  const Segments segments = found(scene);
  ASSERT_EQ(segments.size(), 2U);
  for (const Segment& segment : segments) {
    EXPECT_EQ(segment.echoes.size(), 55U + 20U);
    EXPECT_EQ(segment.new_echoes, 55);
  }
}

/// A mover whose nearest neighbour stands 0.4 m away: one cluster, two parts for a finer eye.
class Trimming : public ::testing::Test {
 protected:
  void build(double mover_height, Place neighbour, double neighbour_height) {
    scene_.face({5.11, 0.1, 0.3}, {0.0, 1.0, 0.0}, mover_height, Place::kNew);
    mover_ = scene_.judged.points.size();
    scene_.face({5.51, 0.1, 0.3}, {0.0, 1.0, 0.0}, neighbour_height, neighbour);
    segments_ = found(scene_);
    ASSERT_EQ(segments_.size(), 1U);
    ASSERT_EQ(segments_[0].echoes.size(), scene_.judged.points.size());
  }

  /// Numbers of the echoes that move.
  std::vector<std::size_t> moving(Proof proof = Proof::kEnteredFree) {
    std::vector<Proof> proofs;
    trimmer_.trim(scene_.judged, segments_, {{proof, false}}, proofs);
    std::vector<std::size_t> echoes;
    for (std::size_t i = 0; i < proofs.size(); ++i) {
      if (proofs[i] == Proof::kNone) continue;
      EXPECT_EQ(proofs[i], proof);
      echoes.push_back(i);
    }
    return echoes;
  }

  JudgedScene scene_{0.0};
  std::size_t mover_ = 0;
  Trimmer trimmer_{kReach, ObjectConfig{}};
  Segments segments_;
};

TEST_F(Trimming, ASettledNeighbourGoes) {
  build(1.2, Place::kSettled, 1.2);
  const std::vector<std::size_t> echoes = moving();
  ASSERT_EQ(echoes.size(), mover_);
  EXPECT_EQ(echoes.back(), mover_ - 1);
}

TEST_F(Trimming, AnUnobservedPartThatIsSmallerStays) {
  build(1.2, Place::kUnobserved, 0.8);
  EXPECT_EQ(moving().size(), scene_.judged.points.size());
}

TEST_F(Trimming, AnUnobservedNeighbourThatIsLargerGoes) {
  build(0.8, Place::kUnobserved, 1.2);
  EXPECT_EQ(moving().size(), mover_);
}

TEST_F(Trimming, WhatDoesNotMoveHasNoProof) {
  build(1.2, Place::kSettled, 1.2);
  EXPECT_TRUE(moving(Proof::kNone).empty());
}

/// A car's rear and side at x 5 to 9, y 2 to 3.8, that touches the front of a house seen for the first time.
JudgedScene carAtAHouse() {
  JudgedScene scene(0.0);
  scene.face({5.0, 2.0, 0.3}, {4.0, 0.0, 0.0}, 1.2, Place::kUnobserved);
  scene.face({5.0, 2.0, 0.3}, {0.0, 1.8, 0.0}, 1.2, Place::kUnobserved);
  scene.face({2.0, 4.1, 0.3}, {14.0, 0.0, 0.0}, 3.0, Place::kUnobserved);
  return scene;
}

Prediction expectedCar(bool moves_whole = true, double x = 7.0) {
  return {{x, 2.9, 0.9}, {4.0, 1.8, 1.2}, {4.0, 1.8, 1.2}, moves_whole};
}

TEST(Segmenter, WhatIsExpectedIsCutOutOfWhatItRanInto) {
  const JudgedScene scene = carAtAHouse();
  EXPECT_EQ(found(scene).size(), 1U);
  const Segments segments = found(scene, {expectedCar()});
  ASSERT_EQ(segments.size(), 2U);
  EXPECT_FALSE(segments[0].cut_out);
  EXPECT_TRUE(segments[1].cut_out);
  EXPECT_EQ(segments[1].echoes.size(), (41U + 19U) * 13U);
  EXPECT_NEAR(segments[1].extent().x(), 4.0, 1e-4);
  EXPECT_EQ(segments[0].echoes.size() + segments[1].echoes.size(), scene.judged.points.size());
}

TEST(Segmenter, NothingIsCutOutWithoutAReason) {
  const JudgedScene scene = carAtAHouse();
  EXPECT_EQ(found(scene, {expectedCar(false)}).size(), 1U) << "it was never seen to move as one";
  EXPECT_EQ(found(scene, {expectedCar(true, 40.0)}).size(), 1U) << "it is expected elsewhere";
  EXPECT_EQ(found(scene, {{{9.0, 4.0, 1.5}, {14.0, 2.4, 3.0}, {14.0, 2.4, 3.0}, true}}).size(), 1U)
      << "the whole looks like it";
  EXPECT_EQ(found(scene, {{{5.0, 2.0, 0.9}, {0.6, 0.6, 1.2}, {0.6, 0.6, 1.2}, true}}).size(), 1U)
      << "too short to settle under itself";
}

TEST(Segmenter, ALongThingThatIsExpectedStaysWholeWhereItsSideSettles) {
  JudgedScene scene(0.0);
  scene.face({5.0, 2.0, 0.3}, {0.0, 1.8, 0.0}, 1.2, Place::kUnobserved);
  scene.face({5.0, 2.0, 0.3}, {1.2, 0.0, 0.0}, 1.2, Place::kSettled);
  scene.face({6.3, 2.0, 0.3}, {2.7, 0.0, 0.0}, 1.2, Place::kUnobserved);
  for (int i = 0; i < 6; ++i) scene.echo({9.0, 2.0, 0.3 + 0.1 * i}, Place::kNew);
  const Segments apart = found(scene);
  EXPECT_EQ(std::count_if(apart.begin(), apart.end(), [](const Segment& c) { return c.settled_echoes > 0; }), 0);
  const Segments whole = found(scene, {expectedCar(false)});
  ASSERT_EQ(whole.size(), 1U);
  EXPECT_EQ(whole[0].echoes.size(), scene.judged.points.size());
}

TEST(Segmenter, AThingThatHidesAmongWhatIsSettledIsTakenFromIt) {
  JudgedScene scene(0.0);
  scene.face({6.0, 1.0, 0.3}, {0.0, 0.5, 0.0}, 1.5, Place::kUnobserved);
  scene.face({6.0, 1.6, 0.3}, {0.0, 6.0, 0.0}, 1.5, Place::kSettled);
  EXPECT_EQ(found(scene)[0].settled_echoes, 61 * 16) << "nothing is new, nothing is expected";
  const Segments segments = found(scene, {{{6.0, 1.2, 1.0}, {0.1, 0.5, 1.5}, {0.1, 0.5, 1.5}, false}});
  ASSERT_EQ(segments.size(), 1U);
  EXPECT_EQ(segments[0].echoes.size(), 6U * 16U);
}

TEST(Segmenter, APoleIsSlimAndHigh) {
  const auto isPole = [](double x, double y, double height) {
    Segment segment;
    segment.high = Eigen::Vector3d(x, y, height);
    return SegmentRules(ObjectConfig{}).isPole(segment);
  };
  EXPECT_TRUE(isPole(0.1, 0.05, 1.5));
  EXPECT_FALSE(isPole(0.3, 0.1, 1.5)) << "somebody from the side";
  EXPECT_FALSE(isPole(0.1, 0.1, 0.4)) << "part of anything";
}

TEST(Segmenter, AnEdgeIsThinAndFarThingsAreNot) {
  Segment edge;
  edge.low = Eigen::Vector3d(12.0, -1.0, 2.0);
  edge.high = Eigen::Vector3d(12.0, 1.0, 2.1);
  EXPECT_TRUE(SegmentRules(ObjectConfig{}).isThin(edge, Eigen::Vector3d::Zero()));
  EXPECT_FALSE(SegmentRules(ObjectConfig{}).isThin(edge, Eigen::Vector3d(-20.0, 0.0, 0.0)))
      << "beams are too sparse to tell";
  edge.high.z() = 2.5;
  EXPECT_FALSE(SegmentRules(ObjectConfig{}).isThin(edge, Eigen::Vector3d::Zero()));
}

}  // namespace
}  // namespace donex
