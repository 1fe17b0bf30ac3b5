#include <limits>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "core/motion/motion_samples.h"
#include "donex/motion/rigid_motion.h"

namespace donex {
namespace {

using testing::distanceBetween;
using testing::randomPose;
using testing::randomTwist;
using testing::rotationBetween;

TEST(IntegrateTwist, QuarterTurnFollowsTheCircle) {
  Twist twist;
  twist.linear.x() = 10.0;
  twist.angular.z() = 0.5;
  const double quarter = M_PI;  // 0.5 rad/s for pi seconds: 90 degrees on a circle of 20 m
  const Eigen::Isometry3d end = integrateTwist(twist, quarter);
  EXPECT_NEAR(end.translation().x(), 20.0, 1e-12);
  EXPECT_NEAR(end.translation().y(), 20.0, 1e-12);
  EXPECT_NEAR(end.translation().z(), 0.0, 1e-12);
  EXPECT_NEAR((end.linear() * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 0.0, 1e-12);
}

TEST(IntegrateTwist, AThousandStepsMakeTheWhole) {
  std::mt19937 random(1);
  for (int round = 0; round < 20; ++round) {
    const Twist twist = randomTwist(random);
    Eigen::Isometry3d composed = Eigen::Isometry3d::Identity();
    for (int step = 0; step < 1000; ++step) composed = composed * integrateTwist(twist, 0.01);
    const Eigen::Isometry3d whole = integrateTwist(twist, 10.0);
    EXPECT_LT(distanceBetween(composed, whole), 1e-9);
    EXPECT_LT(rotationBetween(composed, whole), 1e-7);
  }
}

TEST(IntegrateTwist, BackwardsUndoesForwards) {
  std::mt19937 random(2);
  for (int round = 0; round < 200; ++round) {
    const Twist twist = randomTwist(random);
    const Eigen::Isometry3d loop = integrateTwist(twist, 0.7) * integrateTwist(twist, -0.7);
    EXPECT_TRUE(loop.isApprox(Eigen::Isometry3d::Identity(), 1e-12));
  }
}

TEST(IntegrateTwist, SmallAnglesJoinTheClosedForm) {
  std::mt19937 random(3);
  for (int round = 0; round < 200; ++round) {
    Twist twist = randomTwist(random);
    twist.angular.normalize();
    // On both sides of where the series takes over; between, only the tiny rotation itself may differ.
    const Eigen::Isometry3d below = integrateTwist({twist.linear, twist.angular * 0.9999e-4}, 1.0);
    const Eigen::Isometry3d above = integrateTwist({twist.linear, twist.angular * 1.0001e-4}, 1.0);
    EXPECT_LT(distanceBetween(below, above), 1e-6);
    EXPECT_LT(distanceBetween(integrateTwist({twist.linear, Eigen::Vector3d::Zero()}, 1.0), below), 1e-2);
  }
}

TEST(Interpolate, EndsMiddleAndBeyond) {
  std::mt19937 random(4);
  for (int round = 0; round < 200; ++round) {
    const Eigen::Isometry3d from = randomPose(random, 50.0);
    const Eigen::Isometry3d to = from * integrateTwist(randomTwist(random), 0.1);
    EXPECT_TRUE(interpolate(from, to, 0.0).isApprox(from, 1e-12));
    EXPECT_TRUE(interpolate(from, to, 1.0).isApprox(to, 1e-12));
    const Eigen::Isometry3d middle = interpolate(from, to, 0.5);
    EXPECT_NEAR(distanceBetween(from, middle), distanceBetween(middle, to), 1e-12);
    EXPECT_NEAR(rotationBetween(from, middle), rotationBetween(middle, to), 1e-7);
    const Eigen::Isometry3d beyond = interpolate(from, to, 2.0);
    EXPECT_NEAR(distanceBetween(to, beyond), distanceBetween(from, to), 1e-10);
    EXPECT_NEAR(rotationBetween(to, beyond), rotationBetween(from, to), 1e-7);
  }
}

TEST(Interpolate, TakesTheShortWayRound) {
  Eigen::Isometry3d from = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d to = Eigen::Isometry3d::Identity();
  from.rotate(Eigen::AngleAxisd(M_PI - 0.1, Eigen::Vector3d::UnitZ()));
  to.rotate(Eigen::AngleAxisd(-M_PI + 0.1, Eigen::Vector3d::UnitZ()));
  EXPECT_NEAR(rotationBetween(from, interpolate(from, to, 0.5)), 0.1, 1e-9);
}

TEST(Orthonormalised, RepairsDriftAndKeepsThePlace) {
  std::mt19937 random(5);
  for (int round = 0; round < 100; ++round) {
    const Eigen::Isometry3d pose = randomPose(random, 50.0);
    Eigen::Isometry3d drifted = pose;
    drifted.linear() *= 1.0 + 1e-6;
    const Eigen::Isometry3d repaired = orthonormalised(drifted);
    EXPECT_TRUE((repaired.linear().transpose() * repaired.linear()).isIdentity(1e-12));
    EXPECT_TRUE(repaired.isApprox(pose, 1e-5));
  }
}

TEST(CheckedPose, AcceptsRotationsUpToRounding) {
  const Eigen::Quaterniond rotation(Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ()));
  Eigen::Quaterniond rounded = rotation;
  rounded.coeffs() *= 1.005;
  const auto pose = checkedPose({1.0, 2.0, 3.0}, rounded);
  ASSERT_TRUE(pose.ok());
  EXPECT_EQ(pose->translation(), Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_TRUE(pose->linear().isApprox(rotation.toRotationMatrix(), 1e-12));
}

TEST(CheckedPose, RefusesWhatIsNoPose) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  const Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  EXPECT_EQ(checkedPose({nan, 0.0, 0.0}, turn).fault(), MotionFault::kNonFinite);
  EXPECT_EQ(checkedPose({0.0, infinity, 0.0}, turn).fault(), MotionFault::kNonFinite);
  EXPECT_EQ(checkedPose(origin, {nan, 0.0, 0.0, 0.0}).fault(), MotionFault::kNonFinite);
  EXPECT_EQ(checkedPose(origin, {0.0, 0.0, 0.0, 0.0}).fault(), MotionFault::kNonUnitQuaternion);
  EXPECT_EQ(checkedPose(origin, {1.02, 0.0, 0.0, 0.0}).fault(), MotionFault::kNonUnitQuaternion);
  EXPECT_EQ(checkedPose(origin, {0.5, 0.5, 0.5, 0.0}).fault(), MotionFault::kNonUnitQuaternion);
}

TEST(MotionFault, EachHasItsOwnWords) {
  std::set<std::string> words;
  for (int fault = 0; fault <= static_cast<int>(MotionFault::kSizeMismatch); ++fault) {
    words.insert(describe(static_cast<MotionFault>(fault)));
  }
  EXPECT_EQ(words.size(), static_cast<std::size_t>(MotionFault::kSizeMismatch) + 1);
}

}  // namespace
}  // namespace donex
