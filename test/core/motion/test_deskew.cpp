#include <limits>

#include <gtest/gtest.h>

#include "core/motion/motion_samples.h"
#include "donex/motion/deskew.h"

namespace donex {
namespace {

using testing::randomPose;
using testing::randomTwist;
using testing::randomVector;
using testing::SteadyDrive;

const float kNan = std::numeric_limits<float>::quiet_NaN();

/// Static landmarks as a moving sensor sees them, each at its own time.
struct SkewedScan {
  double stamp = 50.0;
  Eigen::Isometry3d mounting = Eigen::Isometry3d::Identity();
  EgoMotion motion;
  std::vector<float> times;
  std::vector<Eigen::Vector3f> echoes, truth;
};

SkewedScan makeSkewedScan(std::mt19937& random) {
  SkewedScan scan;
  SteadyDrive drive;
  drive.twist = randomTwist(random);
  drive.start = randomPose(random, 100.0);
  drive.epoch = scan.stamp;
  scan.mounting = randomPose(random, 2.0);
  for (int i = -20; i <= 20; ++i) scan.motion.add(drive.sampleAt(scan.stamp + 0.01 * i));
  std::uniform_real_distribution<float> time(-0.1F, 0.1F);
  const Eigen::Isometry3d odom_from_sensor = drive.poseAt(scan.stamp) * scan.mounting;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d landmark = randomVector(random, 80.0);  // sensor frame at the stamp
    const float t = time(random);
    const Eigen::Isometry3d odom_from_sensor_then = drive.poseAt(scan.stamp + static_cast<double>(t)) * scan.mounting;
    scan.times.push_back(t);
    scan.truth.push_back(landmark.cast<float>());
    scan.echoes.push_back((odom_from_sensor_then.inverse() * odom_from_sensor * landmark).cast<float>());
  }
  return scan;
}

MotionFault deskewScan(SkewedScan& scan) {
  return deskew(scan.motion, scan.stamp, scan.mounting, scan.times, scan.echoes);
}

TEST(Deskew, PutsLandmarksWhereTheyAre) {
  std::mt19937 random(21);
  for (int round = 0; round < 10; ++round) {
    SkewedScan scan = makeSkewedScan(random);
    const auto skewed = scan.echoes;
    ASSERT_EQ(deskewScan(scan), MotionFault::kNone);
    float worst = 0.0F, worst_before = 0.0F;
    for (std::size_t i = 0; i < scan.echoes.size(); ++i) {
      worst = std::max(worst, (scan.echoes[i] - scan.truth[i]).norm());
      worst_before = std::max(worst_before, (skewed[i] - scan.truth[i]).norm());
    }
    EXPECT_GT(worst_before, 0.1F);  // there was something to undo
    EXPECT_LT(worst, 0.005F);       // chords of the odometry's arcs at 100 Hz, and rounding
  }
}

TEST(Deskew, LeavesASensorAtRestAlone) {
  EgoMotion motion;
  for (const double stamp : {0.0, 0.1, 0.2}) motion.add(SteadyDrive().sampleAt(stamp));
  std::vector<Eigen::Vector3f> echoes{{1.0F, 2.0F, 3.0F}, {-40.0F, 5.0F, 0.5F}};
  const auto before = echoes;
  ASSERT_EQ(deskew(motion, 0.1, Eigen::Isometry3d::Identity(), {-0.1F, 0.1F}, echoes), MotionFault::kNone);
  for (std::size_t i = 0; i < echoes.size(); ++i) EXPECT_LT((echoes[i] - before[i]).norm(), 1e-4F);
}

TEST(Deskew, KeepsNonFiniteEchoesAndIgnoresTheirTimes) {
  std::mt19937 random(22);
  SkewedScan scan = makeSkewedScan(random);
  scan.echoes[5] = {kNan, 1.0F, 2.0F};
  scan.times[5] = kNan;
  scan.echoes[6].z() = std::numeric_limits<float>::infinity();
  scan.times[6] = 1e9F;
  ASSERT_EQ(deskewScan(scan), MotionFault::kNone);
  EXPECT_TRUE(std::isnan(scan.echoes[5].x()));
  EXPECT_EQ(scan.echoes[5].z(), 2.0F);
  EXPECT_TRUE(std::isinf(scan.echoes[6].z()));
}

TEST(Deskew, NamesTheFaultAndTouchesNothing) {
  std::mt19937 random(23);
  const SkewedScan good = makeSkewedScan(random);
  const auto expectFault = [&](SkewedScan scan, MotionFault fault) {
    EXPECT_EQ(deskewScan(scan), fault);
    EXPECT_EQ(scan.echoes, good.echoes);
  };
  SkewedScan scan = good;
  scan.times.pop_back();
  expectFault(scan, MotionFault::kSizeMismatch);
  scan = good;
  scan.times[100] = kNan;
  expectFault(scan, MotionFault::kNonFinite);
  scan = good;
  scan.times[100] = 0.3F;
  expectFault(scan, MotionFault::kNotYetCovered);
  scan = good;
  scan.times[100] = -1.5e9F;
  expectFault(scan, MotionFault::kTooOld);
  scan = good;
  scan.motion.reset();
  expectFault(scan, MotionFault::kNoSamples);
}

TEST(Deskew, SeesAGapWithinTheScan) {
  EgoMotion motion;
  for (const double stamp : {0.0, 0.1, 1.2, 1.3}) motion.add(SteadyDrive().sampleAt(stamp));
  std::vector<Eigen::Vector3f> echoes{{1.0F, 0.0F, 0.0F}, {2.0F, 0.0F, 0.0F}};
  EXPECT_EQ(deskew(motion, 0.1, Eigen::Isometry3d::Identity(), {0.0F, 1.15F}, echoes), MotionFault::kGapTooLong);
}

TEST(Deskew, EmptyScan) {
  EgoMotion motion;
  motion.add({});
  motion.add(SteadyDrive().sampleAt(0.1));
  std::vector<Eigen::Vector3f> echoes;
  EXPECT_EQ(deskew(motion, 0.05, Eigen::Isometry3d::Identity(), {}, echoes), MotionFault::kNone);
}

}  // namespace
}  // namespace donex
