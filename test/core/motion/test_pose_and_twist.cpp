#include <gtest/gtest.h>

#include "core/motion/pose_and_twist.h"

namespace donex {
namespace {

OdometrySample sampleAt(double stamp, double x, double speed) {
  OdometrySample sample;
  sample.stamp = stamp;
  sample.odom_from_base.translation().x() = x;
  sample.twist.linear.x() = speed;
  return sample;
}

TEST(PoseAndTwist, APoseThatNobodyFillsIn) {
  PoseAndTwist both;
  for (int i = 0; i < 30; ++i) {
    const double stamp = 0.02 * i;
    EXPECT_EQ(both.standsStill(sampleAt(stamp, 0.0, 10.0)), stamp > 0.301) << stamp;
  }
  EXPECT_NEAR(both.way(), 5.8, 1e-9);
}

TEST(PoseAndTwist, AVehicleThatStandsOrCreepsIsFine) {
  PoseAndTwist both;
  for (int i = 0; i < 500; ++i) EXPECT_FALSE(both.standsStill(sampleAt(0.02 * i, 0.0, 0.0))) << i;
  for (int i = 500; i < 1000; ++i) EXPECT_FALSE(both.standsStill(sampleAt(0.02 * i, 0.1 * i, 5.0))) << i;
}

TEST(PoseAndTwist, APoseThatIsPublishedSeveralTimesIsFine) {
  PoseAndTwist both;
  for (int i = 0; i < 500; ++i) EXPECT_FALSE(both.standsStill(sampleAt(0.01 * i, 1.0 * (i / 10), 10.0))) << i;
}

TEST(PoseAndTwist, IsFineAgainOnceThePoseMoves) {
  PoseAndTwist both;
  bool stands = false;
  for (int i = 0; i < 30; ++i) stands = both.standsStill(sampleAt(0.02 * i, 3.0, 10.0));
  EXPECT_TRUE(stands);
  EXPECT_FALSE(both.standsStill(sampleAt(0.6, 9.0, 10.0)));
}

}  // namespace
}  // namespace donex
