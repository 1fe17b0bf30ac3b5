// Which connected echoes are one thing, and which of them only stand close to it.
#include <algorithm>

#include <gtest/gtest.h>

#include "core/objects/candidate_finder.h"
#include "support/judged_things.h"

namespace donex {
namespace {

using testing::JudgedThings;

constexpr double kReach = 40.0;

Candidates found(const JudgedThings& things, const std::vector<Expected>& expected = {}) {
  CandidateFinder finder(kReach, ObjectConfig{});
  Candidates candidates;
  finder.find(things.judged, expected, candidates);
  return candidates;
}

TEST(CandidateFinder, TellsOfEachThingWhatItsEchoesSay) {
  JudgedThings things(0.0);
  things.face({6.0, 1.0, 0.5}, {0.0, 1.0, 0.0}, 1.0, Place::kNew);          // 11 x 11
  things.face({6.0, -4.0, 0.5}, {0.0, 0.5, 0.0}, 1.0, Place::kSettled);     // 6 x 11
  things.face({-6.0, 0.0, 0.5}, {0.0, 0.2, 0.0}, 0.2, Place::kUnobserved);  // 3 x 3
  things.judged.odom_from_points.translation() << 100.0, 0.0, 0.0;
  const Candidates candidates = found(things);
  ASSERT_EQ(candidates.size(), 3U);
  EXPECT_EQ(candidates[0].echoes.size(), 121U);
  EXPECT_EQ(candidates[0].new_echoes, 121);
  EXPECT_EQ(candidates[0].settled_echoes, 0);
  EXPECT_TRUE(candidates[0].center().isApprox(Eigen::Vector3d(106.0, 1.5, 1.0), 1e-4)) << candidates[0].center();
  EXPECT_NEAR(candidates[0].extent().y(), 1.0, 1e-4);
  EXPECT_EQ(candidates[1].settled_echoes, 66);
  EXPECT_EQ(candidates[1].new_echoes, 0);
  EXPECT_EQ(candidates[2].echoes.size(), 9U);
  EXPECT_EQ(candidates[2].new_echoes + candidates[2].settled_echoes, 0);
}

TEST(CandidateFinder, TooFewEchoesAreNoThing) {
  for (const int echoes : {4, 5}) {
    JudgedThings things(0.0);
    for (int i = 0; i < echoes; ++i) things.echo({6.0, 0.1 * i, 1.0}, Place::kNew);
    EXPECT_EQ(found(things).size(), echoes < ObjectConfig{}.min_echoes ? 0U : 1U);
  }
}

TEST(CandidateFinder, IsNewWhereEnoughIsNew) {
  const ObjectConfig config;  // at least 5, more than 0.4 of new and settled, more than 0.15 of all
  const auto isNewOf = [&](int fresh, int settled, std::size_t all, double length = 4.0) {
    Candidate candidate;
    candidate.new_echoes = fresh;
    candidate.settled_echoes = settled;
    candidate.echoes.resize(all);
    candidate.high = Eigen::Vector3d(length, 1.0, 1.0);
    return isNew(candidate, config);
  };
  EXPECT_TRUE(isNewOf(5, 0, 10));
  EXPECT_FALSE(isNewOf(4, 0, 4));
  EXPECT_TRUE(isNewOf(41, 59, 100));
  EXPECT_FALSE(isNewOf(39, 61, 100));
  EXPECT_TRUE(isNewOf(16, 0, 100));
  EXPECT_FALSE(isNewOf(14, 0, 100));
  EXPECT_TRUE(isNewOf(50, 0, 100, 24.0));
  EXPECT_FALSE(isNewOf(50, 0, 100, 26.0)) << "longer than any vehicle";
}

TEST(CandidateFinder, APedestrianAtAWallIsOnlyHimself) {
  JudgedThings things(0.0);
  things.face({10.0, -8.0, 0.3}, {0.0, 16.0, 0.0}, 2.0, Place::kSettled);
  const std::size_t wall = things.judged.points.size();
  things.face({9.8, 1.0, 0.3}, {0.0, 0.4, 0.0}, 1.5, Place::kNew);
  const std::size_t pedestrian = things.judged.points.size() - wall;
  const Candidates candidates = found(things);
  ASSERT_EQ(candidates.size(), 1U);
  EXPECT_EQ(candidates[0].echoes.size(), pedestrian);
  EXPECT_EQ(candidates[0].echoes.front(), wall);
  EXPECT_TRUE(isNew(candidates[0], ObjectConfig{}));
}

TEST(CandidateFinder, TwoPedestriansAtAWallAreTwoWithWhatIsUnobservedOfThem) {
  JudgedThings things(0.0);
  things.face({10.0, -8.0, 0.3}, {0.0, 16.0, 0.0}, 2.0, Place::kSettled);
  for (const double y : {-4.0, 3.0}) {
    things.face({9.8, y, 0.3}, {0.0, 0.4, 0.0}, 1.0, Place::kNew);
    things.face({9.8, y, 1.4}, {0.0, 0.4, 0.0}, 0.3, Place::kUnobserved);
  }
  const Candidates candidates = found(things);
  ASSERT_EQ(candidates.size(), 2U);
  for (const Candidate& candidate : candidates) {
    EXPECT_EQ(candidate.echoes.size(), 55U + 20U);
    EXPECT_EQ(candidate.new_echoes, 55);
  }
}

/// A mover whose nearest neighbour stands 0.4 m away: one cluster, two parts for a finer eye.
class Release : public ::testing::Test {
 protected:
  void build(double mover_height, Place neighbour, double neighbour_height) {
    things_.face({5.11, 0.1, 0.3}, {0.0, 1.0, 0.0}, mover_height, Place::kNew);
    mover_ = things_.judged.points.size();
    things_.face({5.51, 0.1, 0.3}, {0.0, 1.0, 0.0}, neighbour_height, neighbour);
    candidates_ = found(things_);
    ASSERT_EQ(candidates_.size(), 1U);
    ASSERT_EQ(candidates_[0].echoes.size(), things_.judged.points.size());
  }

  std::size_t kept(bool dynamic = true) {
    candidates_[0].dynamic = dynamic;
    finder_.release(things_.judged, candidates_);
    return candidates_[0].echoes.size();
  }

  JudgedThings things_{0.0};
  std::size_t mover_ = 0;
  CandidateFinder finder_{kReach, ObjectConfig{}};
  Candidates candidates_;
};

TEST_F(Release, ASettledNeighbourGoes) {
  build(1.2, Place::kSettled, 1.2);
  EXPECT_EQ(kept(), mover_);
  EXPECT_LT(*std::max_element(candidates_[0].echoes.begin(), candidates_[0].echoes.end()), mover_);
}

TEST_F(Release, AnUnobservedPartThatIsSmallerStays) {
  build(1.2, Place::kUnobserved, 0.8);
  EXPECT_EQ(kept(), things_.judged.points.size());
}

TEST_F(Release, AnUnobservedNeighbourThatIsLargerGoes) {
  build(0.8, Place::kUnobserved, 1.2);
  EXPECT_EQ(kept(), mover_);
}

TEST_F(Release, WhatDoesNotMoveIsLeftAsItIs) {
  build(1.2, Place::kSettled, 1.2);
  EXPECT_EQ(kept(false), things_.judged.points.size());
}

/// A car's rear and side at x 5 to 9, y 2 to 3.8, that touches the front of a house seen for the first time.
JudgedThings carAtAHouse() {
  JudgedThings things(0.0);
  things.face({5.0, 2.0, 0.3}, {4.0, 0.0, 0.0}, 1.2, Place::kUnobserved);
  things.face({5.0, 2.0, 0.3}, {0.0, 1.8, 0.0}, 1.2, Place::kUnobserved);
  things.face({2.0, 4.1, 0.3}, {14.0, 0.0, 0.0}, 3.0, Place::kUnobserved);
  return things;
}

Expected expectedCar(bool moves_whole = true, double x = 7.0) { return {{x, 2.9, 0.9}, {4.0, 1.8, 1.2}, moves_whole}; }

TEST(CandidateFinder, WhatIsExpectedIsCutOutOfWhatItRanInto) {
  const JudgedThings things = carAtAHouse();
  EXPECT_EQ(found(things).size(), 1U);
  const Candidates candidates = found(things, {expectedCar()});
  ASSERT_EQ(candidates.size(), 2U);
  EXPECT_FALSE(candidates[0].cut_out);
  EXPECT_TRUE(candidates[1].cut_out);
  EXPECT_EQ(candidates[1].echoes.size(), (41U + 19U) * 13U);
  EXPECT_NEAR(candidates[1].extent().x(), 4.0, 1e-4);
  EXPECT_EQ(candidates[0].echoes.size() + candidates[1].echoes.size(), things.judged.points.size());
}

TEST(CandidateFinder, NothingIsCutOutWithoutAReason) {
  const JudgedThings things = carAtAHouse();
  EXPECT_EQ(found(things, {expectedCar(false)}).size(), 1U) << "it was never seen to move as one";
  EXPECT_EQ(found(things, {expectedCar(true, 40.0)}).size(), 1U) << "it is expected elsewhere";
  EXPECT_EQ(found(things, {{{9.0, 4.0, 1.5}, {14.0, 2.4, 3.0}, true}}).size(), 1U) << "the whole looks like it";
  EXPECT_EQ(found(things, {{{5.0, 2.0, 0.9}, {0.6, 0.6, 1.2}, true}}).size(), 1U) << "too short to settle under itself";
}

TEST(CandidateFinder, ALongThingThatIsExpectedStaysWholeWhereItsSideSettles) {
  JudgedThings things(0.0);
  things.face({5.0, 2.0, 0.3}, {0.0, 1.8, 0.0}, 1.2, Place::kUnobserved);
  things.face({5.0, 2.0, 0.3}, {1.2, 0.0, 0.0}, 1.2, Place::kSettled);
  things.face({6.3, 2.0, 0.3}, {2.7, 0.0, 0.0}, 1.2, Place::kUnobserved);
  for (int i = 0; i < 6; ++i) things.echo({9.0, 2.0, 0.3 + 0.1 * i}, Place::kNew);
  const Candidates apart = found(things);
  EXPECT_EQ(std::count_if(apart.begin(), apart.end(), [](const Candidate& c) { return c.settled_echoes > 0; }), 0);
  const Candidates whole = found(things, {expectedCar(false)});
  ASSERT_EQ(whole.size(), 1U);
  EXPECT_EQ(whole[0].echoes.size(), things.judged.points.size());
}

TEST(CandidateFinder, AThingThatHidesAmongWhatIsSettledIsTakenFromIt) {
  JudgedThings things(0.0);
  things.face({6.0, 1.0, 0.3}, {0.0, 0.5, 0.0}, 1.5, Place::kUnobserved);
  things.face({6.0, 1.6, 0.3}, {0.0, 6.0, 0.0}, 1.5, Place::kSettled);
  EXPECT_EQ(found(things)[0].settled_echoes, 61 * 16) << "nothing is new, nothing is expected";
  const Candidates candidates = found(things, {{{6.0, 1.2, 1.0}, {0.1, 0.5, 1.5}, false}});
  ASSERT_EQ(candidates.size(), 1U);
  EXPECT_EQ(candidates[0].echoes.size(), 6U * 16U);
}

TEST(CandidateFinder, AnEdgeIsThinAndFarThingsAreNot) {
  Candidate edge;
  edge.low = Eigen::Vector3d(12.0, -1.0, 2.0);
  edge.high = Eigen::Vector3d(12.0, 1.0, 2.1);
  EXPECT_TRUE(isThin(edge, Eigen::Vector3d::Zero()));
  EXPECT_FALSE(isThin(edge, Eigen::Vector3d(-20.0, 0.0, 0.0))) << "beams are too sparse to tell";
  edge.high.z() = 2.5;
  EXPECT_FALSE(isThin(edge, Eigen::Vector3d::Zero()));
}

}  // namespace
}  // namespace donex
