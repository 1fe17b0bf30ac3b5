#include <gtest/gtest.h>

#include "donex/motion/rigid_motion.h"
#include "io/pose.h"
#include "support/sequences.h"

namespace donex {
namespace {

TEST(Pose, SurvivesNormalisingBitForBit) {
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    const Pose pose = test::randomPose(random);
    EXPECT_EQ(pose.orientation.normalized().coeffs(), pose.orientation.coeffs());
  }
}

TEST(Pose, IsWhatOdometryMakesOfIt) {
  std::mt19937 random(2);
  for (int i = 0; i < 2000; ++i) {
    const Pose pose = test::randomPose(random);
    const auto from_message = checkedPose(pose.position, pose.orientation);
    ASSERT_TRUE(from_message.ok());
    EXPECT_EQ(from_message->matrix(), pose.isometry().matrix());
  }
}

TEST(Pose, TakesOutRounding) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> rounding(-5e-5, 5e-5);
  for (int i = 0; i < 2000; ++i) {
    const PoseMatrix exact = test::randomPose(random).isometry().matrix().topRows<3>();
    const PoseMatrix rounded = exact + PoseMatrix::NullaryExpr([&] { return rounding(random); });
    ASSERT_FALSE(faultOfPose(rounded));
    const Eigen::Isometry3d pose = poseFromMatrix(rounded).isometry();
    const Eigen::Matrix3d product = pose.linear() * pose.linear().transpose();
    EXPECT_LT((product - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_LT((pose.matrix().topRows<3>() - exact).cwiseAbs().maxCoeff(), 3e-4);
  }
}

TEST(Pose, FaultsAreNamed) {
  const PoseMatrix sound = Eigen::Isometry3d::Identity().matrix().topRows<3>();
  EXPECT_FALSE(faultOfPose(sound));
  PoseMatrix scaled = sound;
  scaled(0, 0) = 1.01;
  PoseMatrix mirrored = sound;
  mirrored(1, 1) = -1.0;
  PoseMatrix infinite = sound;
  infinite(2, 3) = std::numeric_limits<double>::infinity();
  EXPECT_NE(faultOfPose(scaled)->find("off orthonormal by 0.0201"), std::string::npos);
  EXPECT_NE(faultOfPose(mirrored)->find("mirrors"), std::string::npos);
  EXPECT_NE(faultOfPose(infinite)->find("not finite"), std::string::npos);
  EXPECT_TRUE(faultOfPose(PoseMatrix::Zero()));
}

TEST(Pose, InterpolatesBetweenTheEnds) {
  std::mt19937 random(4);
  const Pose from = test::randomPose(random);
  const Pose to = test::randomPose(random);
  EXPECT_EQ(interpolate(from, to, 0.0).isometry().matrix(), from.isometry().matrix());
  EXPECT_EQ(interpolate(from, to, 1.0).isometry().matrix(), to.isometry().matrix());
  const Pose quarter = interpolate(from, to, 0.25);
  EXPECT_LT((quarter.position - (0.75 * from.position + 0.25 * to.position)).norm(), 1e-12);
  const double whole = from.orientation.angularDistance(to.orientation);
  EXPECT_NEAR(from.orientation.angularDistance(quarter.orientation), 0.25 * whole, 1e-9);
}

}  // namespace
}  // namespace donex
