#include <algorithm>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/motion/motion_samples.h"
#include "donex/motion/ego_motion.h"

namespace donex {
namespace {

using testing::distanceBetween;
using testing::randomPose;
using testing::randomTwist;
using testing::rotationBetween;
using testing::SteadyDrive;

EgoMotion::Options withTwist() {
  EgoMotion::Options options;
  options.source = EgoMotion::Source::kTwist;
  return options;
}

std::vector<OdometrySample> randomSamples(std::mt19937& random, int count, double rate) {
  std::vector<OdometrySample> samples;
  std::uniform_real_distribution<double> jitter(-0.3, 0.3);
  const double epoch = 1.5e9;
  for (int i = 0; i < count; ++i) {
    samples.push_back({epoch + (i + jitter(random)) / rate, randomPose(random, 20.0), randomTwist(random)});
  }
  return samples;
}

TEST(EgoMotion, GivesASamplesPoseBitForBit) {
  std::mt19937 random(11);
  const auto samples = randomSamples(random, 100, 50.0);
  EgoMotion motion;
  for (const auto& sample : samples) ASSERT_EQ(motion.add(sample), AddResult::kAccepted);
  for (const auto& sample : samples) {
    EXPECT_EQ(motion.poseAt(sample.stamp)->matrix(), sample.odom_from_base.matrix());
  }
}

TEST(EgoMotion, LiesBetweenItsNeighbours) {
  std::mt19937 random(12);
  const auto samples = randomSamples(random, 100, 50.0);
  EgoMotion motion;
  for (const auto& sample : samples) motion.add(sample);
  std::uniform_real_distribution<double> fraction(0.0, 1.0);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double f = fraction(random);
    const OdometrySample &a = samples[i - 1], &b = samples[i];
    const auto pose = motion.poseAt(a.stamp + f * (b.stamp - a.stamp));
    ASSERT_TRUE(pose.ok());
    const Eigen::Isometry3d expected = interpolate(a.odom_from_base, b.odom_from_base, f);
    EXPECT_LT(distanceBetween(*pose, expected), 1e-3);  // stamps of today resolve 0.24 us
    EXPECT_LT(rotationBetween(*pose, expected), 1e-3);
  }
}

TEST(EgoMotion, OrderOfArrivalDoesNotMatter) {
  for (const auto source : {EgoMotion::Source::kPose, EgoMotion::Source::kTwist}) {
    std::mt19937 random(13);
    auto samples = randomSamples(random, 40, 100.0);  // 0.4 s: within the allowed disorder
    EgoMotion::Options options;
    options.source = source;
    EgoMotion in_order(options), shuffled(options);
    for (const auto& sample : samples) ASSERT_EQ(in_order.add(sample), AddResult::kAccepted);
    const auto stamps = samples;
    std::shuffle(samples.begin(), samples.end(), random);
    for (const auto& sample : samples) ASSERT_EQ(shuffled.add(sample), AddResult::kAccepted);
    // Integrated velocities have no place of their own: compare the motion since the first sample.
    const Eigen::Isometry3d first = in_order.poseAt(stamps[0].stamp)->inverse();
    const Eigen::Isometry3d first_shuffled = shuffled.poseAt(stamps[0].stamp)->inverse();
    for (std::size_t i = 1; i < stamps.size(); ++i) {
      const double stamp = 0.5 * (stamps[i - 1].stamp + stamps[i].stamp);
      EXPECT_LT(distanceBetween(first * *in_order.poseAt(stamp), first_shuffled * *shuffled.poseAt(stamp)), 1e-9);
    }
  }
}

TEST(EgoMotion, ExtrapolatesOnlyWithinItsBound) {
  for (const auto source : {EgoMotion::Source::kPose, EgoMotion::Source::kTwist}) {
    EgoMotion::Options options;
    options.source = source;
    options.max_extrapolation = 0.05;
    EgoMotion motion(options);
    SteadyDrive drive;
    drive.twist.linear.x() = 10.0;
    for (const double stamp : {0.0, 0.1}) motion.add(drive.sampleAt(stamp));
    const auto pose = motion.poseAt(0.149);
    ASSERT_TRUE(pose.ok());
    EXPECT_NEAR(pose->translation().x(), 1.49, 1e-9);
    EXPECT_EQ(motion.poseAt(0.151).fault(), MotionFault::kNotYetCovered);
    EXPECT_EQ(motion.poseAt(-0.001).fault(), MotionFault::kTooOld);
  }
}

TEST(EgoMotion, OnePoseTellsNoMotion) {
  EgoMotion motion;
  EXPECT_EQ(motion.poseAt(0.0).fault(), MotionFault::kNoSamples);
  motion.add({});
  EXPECT_TRUE(motion.poseAt(0.0).ok());
  EXPECT_EQ(motion.poseAt(0.001).fault(), MotionFault::kNotYetCovered);
}

TEST(EgoMotion, DoesNotInventWhatHappenedInAGap) {
  EgoMotion motion;
  SteadyDrive drive;
  for (const double stamp : {0.0, 0.1, 1.2}) ASSERT_EQ(motion.add(drive.sampleAt(stamp)), AddResult::kAccepted);
  EXPECT_TRUE(motion.poseAt(0.05).ok());
  EXPECT_EQ(motion.poseAt(0.6).fault(), MotionFault::kGapTooLong);
  EXPECT_TRUE(motion.poseAt(1.2).ok());
  EXPECT_EQ(motion.poseAt(1.21).fault(), MotionFault::kGapTooLong);
}

TEST(EgoMotion, TwistStartsAnewAfterAGap) {
  EgoMotion motion(withTwist());
  SteadyDrive drive;
  drive.twist.linear.x() = 1.0;
  motion.add(drive.sampleAt(0.0));
  motion.add(drive.sampleAt(0.5));
  EXPECT_EQ(motion.add(drive.sampleAt(1.6)), AddResult::kTrackLost);
  EXPECT_EQ(motion.size(), 1u);
  EXPECT_EQ(motion.poseAt(0.5).fault(), MotionFault::kTooOld);
}

TEST(EgoMotion, SortsOutWhatArrives) {
  EgoMotion motion;
  SteadyDrive drive;
  EXPECT_EQ(motion.add(drive.sampleAt(10.0)), AddResult::kAccepted);
  EXPECT_EQ(motion.add(drive.sampleAt(10.0)), AddResult::kDuplicate);
  EXPECT_EQ(motion.add(drive.sampleAt(9.6)), AddResult::kAccepted);
  EXPECT_EQ(motion.add(drive.sampleAt(9.4)), AddResult::kTimeRanBack);
  EXPECT_EQ(motion.size(), 2u);
  EXPECT_EQ(motion.oldestStamp(), 9.6);
  EXPECT_EQ(motion.newestStamp(), 10.0);
  motion.reset();
  EXPECT_EQ(motion.add(drive.sampleAt(9.4)), AddResult::kAccepted);
}

TEST(EgoMotion, ADuplicateDoesNotReplaceTheFirst) {
  EgoMotion motion;
  OdometrySample sample;
  sample.odom_from_base.translation().x() = 1.0;
  motion.add(sample);
  sample.odom_from_base.translation().x() = 2.0;
  motion.add(sample);
  EXPECT_EQ(motion.poseAt(0.0)->translation().x(), 1.0);
}

TEST(EgoMotion, RefusesOnlyNaNItWouldUse) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  OdometrySample bad_stamp, bad_pose, bad_twist;
  bad_stamp.stamp = nan;
  bad_pose.odom_from_base.translation().y() = nan;
  bad_twist.twist.angular.z() = nan;
  EgoMotion by_pose, by_twist(withTwist());
  EXPECT_EQ(by_pose.add(bad_stamp), AddResult::kNonFinite);
  EXPECT_EQ(by_twist.add(bad_stamp), AddResult::kNonFinite);
  EXPECT_EQ(by_pose.add(bad_pose), AddResult::kNonFinite);
  EXPECT_EQ(by_twist.add(bad_twist), AddResult::kNonFinite);
  EXPECT_TRUE(by_pose.empty());
  EXPECT_TRUE(by_twist.empty());
  EXPECT_EQ(by_pose.add(bad_twist), AddResult::kAccepted);
  EXPECT_EQ(by_twist.add(bad_pose), AddResult::kAccepted);
  EXPECT_EQ(by_pose.poseAt(nan).fault(), MotionFault::kNonFinite);
}

TEST(EgoMotion, IsBoundedByTime) {
  EgoMotion::Options options;
  options.max_age = 2.0;
  EgoMotion motion(options);
  for (int i = 0; i < 10000; ++i) {
    motion.add(SteadyDrive().sampleAt(0.01 * i));
    ASSERT_LE(motion.size(), 201u);
  }
  EXPECT_GE(motion.size(), 200u);
  EXPECT_EQ(motion.poseAt(90.0).fault(), MotionFault::kTooOld);
}

TEST(EgoMotion, IsBoundedByCount) {
  EgoMotion::Options options;
  options.max_samples = 50;
  EgoMotion motion(options);
  for (int i = 0; i < 1000; ++i) {
    motion.add(SteadyDrive().sampleAt(0.001 * i));
    ASSERT_LE(motion.size(), 50u);
  }
  EXPECT_EQ(motion.add(SteadyDrive().sampleAt(0.9401)), AddResult::kTooOld);
  EXPECT_EQ(motion.add(SteadyDrive().sampleAt(0.9985)), AddResult::kAccepted);
  EXPECT_EQ(motion.size(), 50u);
}

TEST(EgoMotion, AThousandTwistsComposeToTheDrive) {
  std::mt19937 random(14);
  for (int round = 0; round < 5; ++round) {
    SteadyDrive drive;
    drive.twist = randomTwist(random);
    drive.epoch = 100.0;
    EgoMotion motion(withTwist());
    for (int i = 0; i <= 1000; ++i) {
      OdometrySample sample = drive.sampleAt(100.0 + 0.01 * i);
      sample.odom_from_base = randomPose(random, 10.0);  // must not matter
      ASSERT_EQ(motion.add(sample), AddResult::kAccepted);
    }
    const Eigen::Isometry3d driven = motion.poseAt(100.0)->inverse() * *motion.poseAt(110.0);
    EXPECT_LT(distanceBetween(driven, drive.poseAt(110.0)), 1e-8);
    EXPECT_LT(rotationBetween(driven, drive.poseAt(110.0)), 1e-7);
  }
}

TEST(EgoMotion, ChangingTwistIsIntegratedToSecondOrder) {
  // Speed a * t, straight ahead: the distance is a t^2 / 2 exactly when neighbours are averaged.
  EgoMotion motion(withTwist());
  for (int i = 0; i <= 50; ++i) {
    OdometrySample sample;
    sample.stamp = 0.1 * i;
    sample.twist.linear.x() = 3.0 * sample.stamp;
    motion.add(sample);
  }
  EXPECT_NEAR(motion.poseAt(motion.newestStamp())->translation().x(), 0.5 * 3.0 * 25.0, 1e-9);
}

}  // namespace
}  // namespace donex
