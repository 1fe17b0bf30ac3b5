#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/motion/motion_samples.h"
#include "core/motion/planar_completion.h"
#include "core/motion/strange_clouds.h"
#include "core/motion/surfaces.h"

namespace donex {
namespace {

using testing::courtyard;
using testing::distanceBetween;
using testing::rotationBetween;
using testing::seenFrom;
using testing::strangeClouds;

/// As wheels tell it: 4 m/s through a bend.
Eigen::Isometry3d planarPose(int scan) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(0.4 * scan, 0.01 * scan * scan, 0.0);
  pose.linear() = Eigen::AngleAxisd(0.05 * scan, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return pose;
}

/// What the vehicle really does: it sways and rises, once it has driven a metre.
Eigen::Isometry3d truePose(int scan) {
  Eigen::Isometry3d pose = planarPose(scan);
  const double since = std::max(0, scan - 3);
  const Eigen::Vector3d tilt(0.03 * std::sin(0.9 * since), 0.01 * since, 0.0);
  if (since > 0.0) pose.linear() = Eigen::AngleAxisd(tilt.norm(), tilt.normalized()) * pose.linear();
  pose.translation().z() += 0.03 * since;
  return pose;
}

Eigen::Isometry3d mounting() {
  Eigen::Isometry3d base_from_sensor = Eigen::Isometry3d::Identity();
  base_from_sensor.linear() = Eigen::AngleAxisd(0.4, Eigen::Vector3d(0.1, 0.2, 1.0).normalized()).toRotationMatrix();
  base_from_sensor.translation() = Eigen::Vector3d(1.1, -0.2, 0.8);
  return base_from_sensor;
}

double yawBetween(const Eigen::Isometry3d& pose, const Eigen::Isometry3d& other) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(pose.linear() * other.linear().transpose()));
  return std::abs(turn.angle() * turn.axis().z());
}

TEST(PlanarCompletion, FindsHeightRollAndPitchToTheSolversLastStep) {
  const auto world = courtyard();
  PlanarCompletion completion;
  for (int i = 0; i < 12; ++i) {
    const auto echoes = seenFrom(truePose(i) * mounting(), world);
    const Eigen::Isometry3d pose = completion.complete(0.1 * i, echoes, mounting(), planarPose(i));
    EXPECT_EQ(completion.isActive(), i > 1) << "half a metre has to show that it is planar; scan " << i;
    EXPECT_LT(distanceBetween(pose, truePose(i)), 3e-4) << i;
    EXPECT_LT(rotationBetween(pose, truePose(i)), 4e-4) << i;  // yaw is kept, in which tilts show squared
  }
}

TEST(PlanarCompletion, KeepsPlaceAndYawAsGiven) {
  const auto world = courtyard();
  PlanarCompletion completion;
  for (int i = 0; i < 12; ++i) {
    // The odometry drifts to the side: that is not for the scans to mend.
    Eigen::Isometry3d given = planarPose(i);
    given.translation().y() += 0.02 * i;
    const Eigen::Isometry3d pose =
        completion.complete(0.1 * i, seenFrom(truePose(i), world), Eigen::Isometry3d::Identity(), given);
    EXPECT_EQ(pose.translation().x(), given.translation().x());
    EXPECT_EQ(pose.translation().y(), given.translation().y());
    EXPECT_LT(yawBetween(pose, given), 1e-12) << i;
  }
}

/// The largest yaw between poses found and those given, or true ones, where the given yaw is off by `error(scan)`
/// [rad].
template <class Error>
double largestYaw(const Error& error, bool from_given) {
  const auto world = courtyard();
  PlanarCompletion completion;
  double largest = 0.0;
  for (int i = 0; i < 12; ++i) {
    Eigen::Isometry3d given = planarPose(i);
    given.rotate(Eigen::AngleAxisd(error(i), Eigen::Vector3d::UnitZ()));
    const Eigen::Isometry3d pose =
        completion.complete(0.1 * i, seenFrom(planarPose(i), world), Eigen::Isometry3d::Identity(), given);
    largest = std::max(largest, yawBetween(pose, from_given ? given : planarPose(i)));
  }
  return largest;
}

TEST(PlanarCompletion, MendsNoiseOfYaw) {
  const auto error = [](int scan) { return scan > 3 ? 0.004 * std::sin(2.5 * scan) : 0.0; };
  EXPECT_LT(largestYaw(error, false), 6e-4);
}

TEST(PlanarCompletion, LeavesALittleYawAlone) {
  const auto error = [](int scan) { return scan > 3 ? 4e-4 * std::sin(2.5 * scan) : 0.0; };
  EXPECT_LT(largestYaw(error, true), 1e-7);
}

TEST(PlanarCompletion, TurnsNoOdometryByMoreThanItMay) {
  const auto error = [](int scan) { return scan > 3 ? 0.05 : 0.0; };
  EXPECT_NEAR(largestYaw(error, true), PlanarCompletion::Options().most_yaw, 1e-5);
}

TEST(PlanarCompletion, EndsWithoutAStepWhereOdometryLeavesItsPlane) {
  const auto world = courtyard();
  PlanarCompletion completion;
  Eigen::Isometry3d given_before = planarPose(0), pose_before = given_before;
  for (int i = 0; i < 8; ++i) {
    Eigen::Isometry3d given = planarPose(i);
    if (i == 5) given.translation().z() = 0.002;  // once is enough
    const Eigen::Isometry3d pose =
        completion.complete(0.1 * i, seenFrom(truePose(i), world), Eigen::Isometry3d::Identity(), given);
    EXPECT_EQ(completion.isActive(), i > 1 && i < 5) << i;
    const double step = distanceBetween(pose_before.inverse() * pose, given_before.inverse() * given);
    EXPECT_EQ(step > (i < 5 ? 1e-3 : 1e-12), i == 4) << "there is something to find in scan 4 alone; scan " << i;
    given_before = given;
    pose_before = pose;
  }
  EXPECT_GT(distanceBetween(pose_before, given_before), 0.01) << "what was lacking is kept";
  completion.reset();
  for (int i = 0; i < 3; ++i) {
    completion.complete(0.1 * i, seenFrom(truePose(i), world), Eigen::Isometry3d::Identity(), planarPose(i));
  }
  EXPECT_TRUE(completion.isActive()) << "another odometry";
}

TEST(PlanarCompletion, NeverJumpsByAStrangeCloudAndRecovers) {
  const auto world = courtyard();
  for (const auto& strange : strangeClouds()) {
    PlanarCompletion completion;
    int i = 0;
    for (; i < 6; ++i)
      completion.complete(0.1 * i, seenFrom(truePose(i), world), Eigen::Isometry3d::Identity(), planarPose(i));
    for (; i < 9; ++i) {
      const auto pose = completion.complete(0.1 * i, strange.echoes, Eigen::Isometry3d::Identity(), planarPose(i));
      EXPECT_LT(distanceBetween(pose, truePose(i)), 0.15) << strange.name << ", scan " << i;
      EXPECT_LT(rotationBetween(pose, truePose(i)), 0.1) << strange.name << ", scan " << i;
    }
    Eigen::Isometry3d pose;
    for (; i < 12; ++i) {
      pose = completion.complete(0.1 * i, seenFrom(truePose(i), world), Eigen::Isometry3d::Identity(), planarPose(i));
    }
    EXPECT_LT(distanceBetween(pose, truePose(i - 1)), 1e-3) << strange.name;
  }
}

TEST(PlanarCompletion, LeavesOutOfTheMapWhatMoves) {
  const auto world = courtyard();
  PlanarCompletion completion;
  for (int i = 0; i < 6; ++i) {
    const auto echoes = seenFrom(truePose(i), world);
    const auto pose = completion.complete(0.1 * i, echoes, Eigen::Isometry3d::Identity(), planarPose(i));
    EXPECT_TRUE(pose.isApprox(planarPose(i), 0.0)) << "there was nothing to be found";
    const bool is_first_of_the_map = i == 2;
    if (is_first_of_the_map) {
      EXPECT_THROW(completion.learn({}), std::invalid_argument);
    }
    completion.learn(std::vector<std::uint8_t>(echoes.size(), 1));
  }
}

}  // namespace
}  // namespace donex
