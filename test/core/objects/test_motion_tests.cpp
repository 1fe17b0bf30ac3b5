// Former places: what has left them, and what has moved elsewhere.
#include <limits>

#include <gtest/gtest.h>

#include "core/objects/motion_tests.h"
#include "support/judged_scene.h"

namespace donex {
namespace {

using testing::JudgedScene;

/// The trace of an object.
struct Left {
  TraceHistory history{1.0, 0.6};
  TraceHistory::Id last;

  operator Trace() const {
    Trace trace;
    EXPECT_TRUE(history.find(last, std::numeric_limits<double>::infinity(), trace));
    return trace;
  }
};

/// A scan, its sight and its first object as a segment.
struct Seen {
  explicit Seen(const JudgedScene& seen, std::size_t echoes) : scene(seen) {
    history.arrive(scene.scan(), scene.judged.is_echo);
    history.add(scene.scan(), scene.judged.is_echo);
    for (std::size_t i = 0; i < echoes; ++i) segment.echoes.push_back(static_cast<std::uint32_t>(i));
    describeEchoes(scene.judged, segment);
  }

  Left leave() const {
    Left left;
    left.history.begin(scene.judged.stamp);
    left.last = left.history.leave(scene.judged, segment, {});
    return left;
  }
  FormerPlace lookBack(const Trace& trace) const { return MotionTests(scene.judged, now(), options).lookBack(trace); }
  bool hasMoved(const Trace& trace) const { return MotionTests(scene.judged, now(), options).hasMoved(trace, segment); }

  ScanSight now() const { return history.newestSeenFrom(scene.judged.odom_from_points); }

  JudgedScene scene;
  SightHistory history{2.0, 0.0, 0.5F, {true, 0.038}};
  MotionTestOptions options;
  Segment segment;
};

/// Somebody 8 m ahead at y before a wall; the sensor moves along x.
Seen somebody(double y, Place place = Place::kUnobserved, double sensor_x = 0.0, bool hidden = false) {
  JudgedScene scene(0.0, sensor_x);
  scene.face({8.0, y, 0.4}, {0.0, 0.5, 0.0}, 1.4, place, 0.05);
  const std::size_t echoes = scene.judged.points.size();
  if (hidden) scene.face({5.0, -3.0, 0.0}, {0.0, 2.5, 0.0}, 1.8, Place::kSettled, 0.02);
  scene.face({20.0, -15.0, 0.0}, {0.0, 30.0, 0.0}, 5.0, Place::kSettled, 0.1);
  return Seen(scene, echoes);
}

TEST(MotionTests, ATraceIsSpreadOverTheObject) {
  const Left left = somebody(-1.0).leave();
  const Trace trace = left;
  EXPECT_LE(trace.size(), 48U);
  EXPECT_GT(trace.size(), 24U);
  EXPECT_NEAR(trace.center().y(), -0.75, 1e-4);
  for (const Eigen::Vector3d& point : trace) EXPECT_NEAR(point.x(), 8.0, 1e-4);
}

TEST(MotionTests, WhatStandsIsStillThere) {
  const Left trace = somebody(-1.0).leave();
  const Seen now = somebody(-1.0, Place::kUnobserved, 0.5);
  EXPECT_EQ(now.lookBack(trace).left, 0);
  EXPECT_GT(now.lookBack(trace).still, 40);
  EXPECT_FALSE(now.hasMoved(trace));
}

TEST(MotionTests, APlaceIsLeftWhenTheWallBehindItIsSeen) {
  const Left trace = somebody(-2.0).leave();
  const FormerPlace former = somebody(1.0).lookBack(trace);
  EXPECT_GT(former.left, 20) << "all of it before the wall";
  EXPECT_EQ(former.still, 0);
}

TEST(MotionTests, NothingIsKnownOfAPlaceThatIsHiddenNow) {
  const Left trace = somebody(-2.0).leave();
  const Seen now = somebody(1.0, Place::kUnobserved, 0.0, true);
  EXPECT_EQ(now.lookBack(trace).left, 0);
  EXPECT_FALSE(now.hasMoved(trace));
}

TEST(MotionTests, AShapeFoundElsewhereHasMoved) {
  const Left trace = somebody(-2.0).leave();
  EXPECT_TRUE(somebody(-1.2).hasMoved(trace));
  EXPECT_FALSE(somebody(-1.85).hasMoved(trace)) << "not far enough to tell";
  EXPECT_FALSE(somebody(-1.2, Place::kSettled).hasMoved(trace)) << "what is settled stood there";
}

TEST(MotionTests, AnotherShapeIsAnotherObject) {
  const Left trace = somebody(-2.0).leave();
  JudgedScene scene(0.0);
  scene.face({8.0, -0.5, 0.4}, {0.0, 0.1, 0.0}, 0.4, Place::kUnobserved, 0.05);
  const std::size_t echoes = scene.judged.points.size();
  scene.face({20.0, -15.0, 0.0}, {0.0, 30.0, 0.0}, 5.0, Place::kSettled, 0.1);
  EXPECT_FALSE(Seen(scene, echoes).hasMoved(trace));
}

}  // namespace
}  // namespace donex
