// Former places: what has left them, and what has moved elsewhere.
#include <cmath>
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

  bool isDisplaced(const Trace& trace, bool world_is_placed = true) const {
    return MotionTests(scene.judged, now(), options).isDisplaced(trace, segment, world_is_placed);
  }

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

/// The front and a side of a car that comes closer, its front at x, before a wall. All of it is settled: it creeps, and
/// its side slides along itself.
Seen car(double x, double sensor_x = 0.0, double length = 4.0) {
  JudgedScene scene(0.0, sensor_x);
  for (double turn = 0.01; turn < 1.0; turn += 0.004) {
    const double on_front = (x - sensor_x) * std::tan(turn), on_side = sensor_x + 2.0 / std::tan(turn);
    const bool hits_front = on_front >= 2.0 && on_front <= 3.8, hits_side = on_side >= x && on_side <= x + length;
    if (!hits_front && !hits_side) continue;
    const Eigen::Vector2d hit = hits_front ? Eigen::Vector2d(x, on_front) : Eigen::Vector2d(on_side, 2.0);
    const double away = std::hypot(hit.x() - sensor_x, hit.y());
    for (double tilt = -0.3; tilt < 0.0; tilt += 0.007) {
      const double z = 1.8 + tilt * away;
      if (z > 0.3 && z < 1.5) scene.echo({hit.x(), hit.y(), z}, Place::kSettled);
    }
  }
  const std::size_t echoes = scene.judged.points.size();
  scene.face({30.0, -25.0, 0.0}, {0.0, 50.0, 0.0}, 5.0, Place::kSettled, 0.1);
  return Seen(scene, echoes);
}

TEST(MotionTests, ACarThatCreepsIsDisplaced) {
  const Left trace = car(9.0).leave();
  EXPECT_TRUE(car(8.8).isDisplaced(trace));
  EXPECT_FALSE(car(8.8).hasMoved(trace)) << "it hides where it was, and its side is still there";
  EXPECT_TRUE(car(9.3).isDisplaced(trace)) << "going away";
  EXPECT_FALSE(car(8.95).isDisplaced(trace)) << "hardly";
  EXPECT_FALSE(car(6.0).isDisplaced(trace)) << "too far to be the same";
}

TEST(MotionTests, WithoutKnowingTheWorldsShiftMoreIsAskedFor) {
  const Left trace = car(9.0).leave();
  EXPECT_FALSE(car(8.8).isDisplaced(trace, false));
  EXPECT_TRUE(car(8.5).isDisplaced(trace, false));
}

TEST(MotionTests, WhatIsSeenFromElsewhereOrInPartIsNotDisplaced) {
  const Left trace = car(9.0).leave();
  EXPECT_FALSE(car(9.0, 3.0).isDisplaced(trace));
  EXPECT_FALSE(car(9.0, 0.0, 3.0).isDisplaced(trace)) << "its end is hidden now";
  EXPECT_FALSE(car(9.0, 0.0, 5.0).isDisplaced(trace)) << "more of it is seen";
}

/// Two sides of something 0.6 m wide, its near corner at x, 3 m to the left.
Seen column(double x, double sensor_x) {
  JudgedScene scene(0.0, sensor_x);
  scene.face({x, 3.0, 0.3}, {0.6, 0.0, 0.0}, 1.5, Place::kSettled, 0.05);
  scene.face({x, 3.0, 0.3}, {0.0, 0.6, 0.0}, 1.5, Place::kSettled, 0.05);
  const std::size_t echoes = scene.judged.points.size();
  scene.face({-20.0, 15.0, 0.0}, {40.0, 0.0, 0.0}, 5.0, Place::kSettled, 0.1);
  scene.face({20.0, -15.0, 0.0}, {0.0, 30.0, 0.0}, 5.0, Place::kSettled, 0.1);
  return Seen(scene, echoes);
}

TEST(MotionTests, WhatMayShowAnotherSideMustShiftByMore) {
  const Left trace = column(5.0, 0.0).leave();
  EXPECT_TRUE(column(4.75, 0.0).isDisplaced(trace));
  Seen passed_by = column(4.75, 3.0);
  EXPECT_FALSE(passed_by.isDisplaced(trace)) << "something round that stands might look like that";
  passed_by.options.displacement.round = 0.0;
  EXPECT_TRUE(passed_by.isDisplaced(trace)) << "it is only that";
}

TEST(MotionTests, APatchOfGroundIsNotDisplaced) {
  const auto patch = [](double x) {
    JudgedScene scene(0.0);
    for (double along = 0.0; along < 3.0; along += 0.1) {
      for (double across = 0.0; across < 2.0; across += 0.1) {
        scene.echo({x + along, across, 0.3 + 0.1 * along}, Place::kUnobserved);
      }
    }
    const std::size_t echoes = scene.judged.points.size();
    scene.face({20.0, -15.0, 0.0}, {0.0, 30.0, 0.0}, 5.0, Place::kSettled, 0.1);
    return Seen(scene, echoes);
  };
  EXPECT_FALSE(patch(7.6).isDisplaced(patch(8.0).leave()));
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
