#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "core/motion/lidar_odometry.h"
#include "core/motion/motion_samples.h"
#include "core/motion/strange_clouds.h"
#include "core/motion/surfaces.h"

namespace donex {
namespace {

using testing::corridor;
using testing::courtyard;
using testing::distanceBetween;
using testing::rotationBetween;
using testing::seenFrom;
using testing::SteadyDrive;
using testing::StrangeCloud;
using testing::strangeClouds;

SteadyDrive bendingDrive() { return {{{4.0, 0.2, 0.05}, {0.02, -0.03, 0.3}}}; }

TEST(LidarOdometry, FindsPosesAmongPlanesToTheRoundingOfTheEchoes) {
  const auto world = courtyard();
  const SteadyDrive drive = bendingDrive();
  LidarOdometry odometry;
  for (int i = 0; i < 8; ++i) {
    const double stamp = 0.1 * i;
    const auto echoes = seenFrom(drive.poseAt(stamp), world);
    const TrackedScan& tracked = odometry.locate(stamp, echoes);
    const bool is_known = i > 1;
    EXPECT_EQ(tracked.status, is_known ? TrackingStatus::kTracking : TrackingStatus::kStarting) << i;
    EXPECT_LT(distanceBetween(tracked.odom_from_sensor, drive.poseAt(stamp)), 2e-5) << i;
    EXPECT_LT(rotationBetween(tracked.odom_from_sensor, drive.poseAt(stamp)), 2e-6) << i;
  }
}

/// Echoes of a turn that ends at `stamp`, and when each was measured after it: clockwise from behind.
struct TurnEchoes {
  TurnEchoes(const SteadyDrive& drive, double stamp, const std::vector<Eigen::Vector3d>& world) {
    const std::vector<Eigen::Vector3f> seen = seenFrom(drive.poseAt(stamp - 0.5 * kTurn), world);
    for (const Eigen::Vector3f& echo : seen) {
      const double turned = 0.5 - static_cast<double>(std::atan2(echo.y(), echo.x())) / (2.0 * M_PI);
      const double time = kTurn * (turned - 1.0);
      const Eigen::Isometry3d then_from_middle =
          drive.poseAt(stamp + time).inverse() * drive.poseAt(stamp - 0.5 * kTurn);
      echoes.push_back((then_from_middle * echo.cast<double>()).cast<float>());
      times.push_back(static_cast<float>(time));
    }
  }
  static constexpr double kTurn = 0.1;  // [s]
  std::vector<Eigen::Vector3f> echoes;
  std::vector<float> times;
};

TEST(LidarOdometry, StraightensDistortedScans) {
  const auto world = courtyard();
  const SteadyDrive drive{{{8.0, 0.0, 0.0}, {0.0, 0.0, 0.5}}};
  LidarOdometry odometry, blind;
  Eigen::Isometry3d before, blind_before, truth_before;
  double worst = 0.0, worst_blind = 0.0;
  for (int i = 0; i < 12; ++i) {
    const TurnEchoes turn(drive, 0.1 * i, world);
    const TrackedScan tracked = odometry.locate(0.1 * i, turn.echoes, turn.times);
    const TrackedScan blind_tracked = blind.locate(0.1 * i, turn.echoes);
    EXPECT_NEAR(tracked.moment, 0.1 * i - 0.05, 1e-3);
    const Eigen::Isometry3d truth = drive.poseAt(tracked.moment), step = truth_before.inverse() * truth;
    if (i > 3) {
      worst = std::max(worst, distanceBetween(before.inverse() * tracked.odom_from_sensor, step));
      worst_blind =
          std::max(worst_blind, distanceBetween(blind_before.inverse() * blind_tracked.odom_from_sensor, step));
    }
    before = tracked.odom_from_sensor;
    blind_before = blind_tracked.odom_from_sensor;
    truth_before = truth;
  }
  EXPECT_LT(worst, 0.005);
  EXPECT_GT(worst_blind, 2.0 * worst) << "or times are of no use";
}

/// How far off the worst step of five scans is that begin with a bend, after a straight road [m].
double worstStepInABend(const LidarOdometry::Options& options) {
  const auto world = courtyard();
  const SteadyDrive straight{{{8.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}}, bend{{{8.0, 0.0, 0.0}, {0.0, 0.0, 0.5}}};
  LidarOdometry odometry(options);
  Eigen::Isometry3d before, truth_before;
  double worst = 0.0;
  for (int i = -5; i < 6; ++i) {
    const SteadyDrive& drive = i <= 0 ? straight : bend;  // both are at one pose at 0
    const TurnEchoes turn(drive, 0.1 * i, world);
    const TrackedScan tracked = odometry.locate(0.1 * i, turn.echoes, turn.times);
    const Eigen::Isometry3d truth = drive.poseAt(tracked.moment), step = truth_before.inverse() * truth;
    if (i > 0) worst = std::max(worst, distanceBetween(before.inverse() * tracked.odom_from_sensor, step));
    before = tracked.odom_from_sensor;
    truth_before = truth;
  }
  return worst;
}

TEST(LidarOdometry, FollowsASuddenTurnOfDistortedScans) {
  LidarOdometry::Options options;
  const double corrected = worstStepInABend(options);
  options.most_corrections = 0;
  const double uncorrected = worstStepInABend(options);
  EXPECT_LT(corrected, 0.03);
  EXPECT_GT(uncorrected, 1.3 * corrected);
}

TEST(LidarOdometry, WantsATimeForEachEcho) {
  LidarOdometry odometry;
  EXPECT_THROW(odometry.locate(0.0, std::vector<Eigen::Vector3f>(3), std::vector<float>(2)), std::invalid_argument);
}

TEST(LidarOdometry, StartsAtSpeed) {
  const auto world = courtyard();
  for (const double speed : {0.0, 5.0, 12.0, 20.0, -8.0}) {
    const SteadyDrive drive{{{speed, 0.0, 0.0}, {0.0, 0.0, 0.0}}};
    LidarOdometry odometry;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Isometry3d truth = drive.poseAt(0.1 * i);
      const TrackedScan tracked = odometry.locate(0.1 * i, seenFrom(truth, world));
      EXPECT_LT(distanceBetween(tracked.odom_from_sensor, truth), 1e-3) << speed << " m/s, scan " << i;
    }
  }
}

TEST(LidarOdometry, SaysWhereACorridorLeavesItOpenAndUsesTheRest) {
  LidarOdometry odometry;
  const auto world = corridor(-39.9, 39.9);
  for (int i = 0; i < 6; ++i) {
    Eigen::Isometry3d truth = Eigen::Isometry3d::Identity();
    truth.translation().y() = 0.05 * i;  // along y the walls tell; along x the corridor moves with the sensor
    const auto echoes = seenFrom(truth, world);
    const TrackedScan& tracked = odometry.locate(0.1 * i, echoes);
    if (i == 0) continue;
    EXPECT_EQ(tracked.status, TrackingStatus::kDegenerate);
    EXPECT_EQ(tracked.undetermined, 1);
    EXPECT_LT(distanceBetween(tracked.odom_from_sensor, truth), 1e-3);
  }
}

TEST(LidarOdometry, TakesNoTrafficThatKeepsPaceForTheWorld) {
  auto world = corridor(-39.9, 39.9);
  for (const double x : {-20.0, 9.0, 17.0}) {
    testing::addPatch({x, -1.2, -1.0}, {0.1, 2.4, 0.0}, {0.0, 0.0, 2.4}, 0.2, world);
  }
  LidarOdometry odometry;
  for (int i = 0; i < 6; ++i) {
    Eigen::Isometry3d truth = Eigen::Isometry3d::Identity();
    truth.translation().y() = 0.05 * i;
    const TrackedScan& tracked = odometry.locate(0.1 * i, seenFrom(truth, world));
    if (i == 0) continue;
    EXPECT_EQ(tracked.status, TrackingStatus::kDegenerate) << i;
    EXPECT_EQ(tracked.undetermined, 1) << i;
    EXPECT_GT(tracked.least_information, LidarOdometry::registrationOfScans().least_information)
        << "the patches alone would do";
    EXPECT_LT(distanceBetween(tracked.odom_from_sensor, truth), 1e-3) << i;
  }
}

TEST(LidarOdometry, AScanThatMatchesNothingCastsNoDoubtOnTheNext) {
  const auto world = courtyard();
  const SteadyDrive drive{{{5.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}};
  LidarOdometry odometry;
  for (int i = 0; i < 6; ++i) {
    const Eigen::Isometry3d truth = drive.poseAt(0.1 * i);
    const std::vector<Eigen::Vector3f> ahead = seenFrom(truth, world);
    std::vector<Eigen::Vector3f> elsewhere;
    for (const Eigen::Vector3f& echo : ahead) elsewhere.emplace_back(echo + Eigen::Vector3f(0.0F, 0.0F, 60.0F));
    const TrackedScan tracked = odometry.locate(0.1 * i, ahead);
    const bool is_known = i > 1;
    EXPECT_EQ(tracked.status, is_known ? TrackingStatus::kTracking : TrackingStatus::kStarting) << i;
    EXPECT_LT(distanceBetween(tracked.odom_from_sensor, truth), 1e-3) << i;
    EXPECT_EQ(odometry.locate(0.1 * i, elsewhere).status, TrackingStatus::kLost) << i;
  }
}

TEST(LidarOdometry, NeverJumpsByAStrangeCloudAndRecovers) {
  const auto world = courtyard();
  const SteadyDrive drive = bendingDrive();
  for (const StrangeCloud& strange : strangeClouds()) {
    LidarOdometry odometry;
    int i = 0;
    for (; i < 5; ++i) odometry.locate(0.1 * i, seenFrom(drive.poseAt(0.1 * i), world));
    for (; i < 8; ++i) {
      const TrackedScan& tracked = odometry.locate(0.1 * i, strange.echoes);
      EXPECT_NE(tracked.status, TrackingStatus::kTracking) << strange.name;
      EXPECT_LT(distanceBetween(tracked.odom_from_sensor, drive.poseAt(0.1 * i)), 0.15) << strange.name;
    }
    for (; i < 11; ++i) odometry.locate(0.1 * i, seenFrom(drive.poseAt(0.1 * i), world));
    const TrackedScan& tracked = odometry.locate(0.1 * i, seenFrom(drive.poseAt(0.1 * i), world));
    EXPECT_EQ(tracked.status, TrackingStatus::kTracking) << strange.name;
    EXPECT_LT(distanceBetween(tracked.odom_from_sensor, drive.poseAt(0.1 * i)), 1e-3) << strange.name;
  }
}

TEST(LidarOdometry, StrangeCloudsAtTheStartAreNoTrack) {
  for (const StrangeCloud& strange : strangeClouds()) {
    LidarOdometry odometry;
    for (int i = 0; i < 12; ++i) {
      const TrackedScan& tracked = odometry.locate(0.1 * i, strange.echoes);
      EXPECT_NE(tracked.status, TrackingStatus::kTracking) << strange.name;
      EXPECT_LT(tracked.odom_from_sensor.translation().norm(), 0.1) << strange.name;
    }
  }
}

TEST(LidarOdometry, BeginsANewTrackWhereTheOldOneIsLostForGood) {
  const auto world = courtyard();
  auto elsewhere = corridor(-8.0, 8.0);
  for (Eigen::Vector3d& point : elsewhere)
    point = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 0.5, 2.0).normalized()) * point;
  testing::addPatch({8.0, -6.0, 1.0}, {0.5, 12.0, 0.0}, {0.0, 0.0, 5.0}, 0.2, elsewhere);
  LidarOdometry odometry;
  for (int i = 0; i < 4; ++i) odometry.locate(0.1 * i, seenFrom(Eigen::Isometry3d::Identity(), world));
  int new_tracks = 0;
  TrackedScan tracked;
  for (int i = 4; i < 20; ++i) {
    tracked = odometry.locate(0.1 * i, seenFrom(Eigen::Isometry3d::Identity(), elsewhere));
    new_tracks += tracked.is_new_track ? 1 : 0;
  }
  EXPECT_EQ(new_tracks, 1);
  EXPECT_EQ(tracked.status, TrackingStatus::kTracking);
}

TEST(LidarOdometry, LeavesOutOfTheMapWhatMoves) {
  const auto echoes = seenFrom(Eigen::Isometry3d::Identity(), courtyard());
  LidarOdometry odometry;
  odometry.locate(0.0, echoes);
  odometry.learn(std::vector<std::uint8_t>(echoes.size(), 1));
  EXPECT_EQ(odometry.locate(0.1, echoes).status, TrackingStatus::kLost) << "there was nothing to be found";
  EXPECT_THROW(odometry.learn({}), std::invalid_argument);
}

TEST(LidarOdometry, TakesStampsThatDoNotRise) {
  const auto echoes = seenFrom(Eigen::Isometry3d::Identity(), courtyard());
  LidarOdometry odometry;
  for (const double stamp : {0.0, 0.1, 0.1, 0.05, 0.2, 0.3}) {
    EXPECT_LT(odometry.locate(stamp, echoes).odom_from_sensor.translation().norm(), 1e-4) << stamp;
  }
}

TEST(LidarOdometry, ItsMemoryIsBounded) {
  LidarOdometry odometry;
  std::size_t memory = 0;
  const SteadyDrive drive{{{10.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}};
  for (int i = 0; i < 150; ++i) {
    const double x = 1.0 * i;
    auto world = corridor(x - 25.0, x + 25.0);
    odometry.locate(0.1 * i, seenFrom(drive.poseAt(0.1 * i), world));
    if (i == 20) memory = odometry.memoryBytes();
  }
  EXPECT_LT(static_cast<double>(odometry.memoryBytes()), 1.05 * static_cast<double>(memory));
}

}  // namespace
}  // namespace donex
