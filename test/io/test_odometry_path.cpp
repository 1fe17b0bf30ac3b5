#include <gtest/gtest.h>

#include "io/odometry_path.h"
#include "support/sequences.h"

namespace donex {
namespace {

struct Drive {
  std::vector<double> stamps;
  std::vector<Pose> poses;
};

/// Scans at uneven times along a bend.
Drive bend() {
  Drive drive;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> jitter(-0.01, 0.01);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 30; ++i) {
    drive.stamps.push_back(100.0 + 0.1 * i + jitter(random));
    drive.poses.push_back(Pose::fromIsometry(pose));
    pose = pose * integrateTwist({{8.0, 0.2, 0.0}, {0.01, 0.0, 0.5}}, 0.1);
  }
  return drive;
}

TEST(OdometryPath, HoldsEveryPoseAtItsOwnStampBitForBit) {
  const Drive drive = bend();
  for (const double rate : {1.0, 10.0, 100.0}) {
    const auto path = odometryAlong(drive.stamps, drive.poses, {rate, 0.0});
    std::size_t found = 0;
    for (const OdometryPoint& point : path) {
      if (found == drive.stamps.size() || point.stamp != drive.stamps[found]) continue;
      EXPECT_EQ(point.odom_from_base.isometry().matrix(), drive.poses[found].isometry().matrix());
      ++found;
    }
    EXPECT_EQ(found, drive.stamps.size());
  }
}

TEST(OdometryPath, HasTheRate) {
  const Drive drive = bend();
  const double duration = drive.stamps.back() - drive.stamps.front();
  EXPECT_EQ(odometryAlong(drive.stamps, drive.poses, {10.0, 0.0}).size(), drive.stamps.size());
  const auto path = odometryAlong(drive.stamps, drive.poses, {100.0, 0.0});
  EXPECT_NEAR(static_cast<double>(path.size()), 100.0 * duration, 10.0);
  for (std::size_t i = 1; i < path.size(); ++i) {
    EXPECT_GT(path[i].stamp, path[i - 1].stamp);
    EXPECT_LT(path[i].stamp - path[i - 1].stamp, 0.0125);
  }
}

TEST(OdometryPath, TwistIsTheMotionBetweenTheMessages) {
  const Drive drive = bend();
  const auto path = odometryAlong(drive.stamps, drive.poses, {100.0, 0.0});
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const double duration = path[i + 1].stamp - path[i].stamp;
    const Twist mean{0.5 * (path[i].twist.linear + path[i + 1].twist.linear),
                     0.5 * (path[i].twist.angular + path[i + 1].twist.angular)};
    const Eigen::Isometry3d moved = path[i].odom_from_base.isometry() * integrateTwist(mean, duration);
    const Eigen::Isometry3d error = path[i + 1].odom_from_base.isometry().inverse() * moved;
    // Where the velocity jumps, at a scan's stamp, half of a step has the other velocity.
    EXPECT_LT(error.translation().norm(), 0.01);
    EXPECT_LT(Eigen::AngleAxisd(error.linear()).angle(), 1e-3);
  }
  // The times are off by up to a fifth of what the speed was meant for.
  EXPECT_NEAR(path[5].twist.linear.norm(), 8.0, 2.0);
  EXPECT_NEAR(path[5].twist.angular.z(), 0.5, 0.125);
}

TEST(OdometryPath, WithAnOffsetItStillCoversAllScansAndMissesTheirStamps) {
  const Drive drive = bend();
  for (const double offset : {-0.25, -0.003, 0.003, 0.25}) {
    const auto path = odometryAlong(drive.stamps, drive.poses, {10.0, offset});
    EXPECT_LT(path.front().stamp, drive.stamps.front());
    EXPECT_GT(path.back().stamp, drive.stamps.back());
    for (std::size_t i = 0; i < path.size(); ++i) {
      EXPECT_EQ(std::count(drive.stamps.begin(), drive.stamps.end(), path[i].stamp), 0);
      if (i > 0) {
        EXPECT_GT(path[i].stamp, path[i - 1].stamp);
      }
    }
  }
}

TEST(OdometryPath, OneScanStandsStill) {
  std::mt19937 random(9);
  const Pose pose = test::randomPose(random);
  const auto path = odometryAlong({5.0}, {pose}, {10.0, 0.0});
  ASSERT_EQ(path.size(), 1U);
  EXPECT_EQ(path[0].odom_from_base.isometry().matrix(), pose.isometry().matrix());
  EXPECT_EQ(path[0].twist.linear.norm(), 0.0);
}

}  // namespace
}  // namespace donex
