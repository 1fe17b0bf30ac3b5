// LiDAR odometry on simulated drives: where it says that a direction is open, and where it must not.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/motion/lidar_odometry.h"
#include "simulation/simulator.h"

namespace donex {
namespace {

using simulation::SimulatedScan;
using simulation::Simulator;
using simulation::SimulatorOptions;

constexpr int kScans = 20;

struct Step {
  TrackingStatus status = TrackingStatus::kLost;
  double error = 0.0;  // [m] of the motion since the scan before
};

/// The steps of a drive's first scans, without the first.
std::vector<Step> stepsIn(const std::string& scene, int seed) {
  SimulatorOptions options;
  options.seed = seed;
  Simulator simulator(scene, options);
  LidarOdometry odometry;
  std::vector<Step> steps;
  SimulatedScan scan;
  Eigen::Isometry3d found = Eigen::Isometry3d::Identity(), truth = found;
  for (int i = 0; i < kScans && simulator.next(scan); ++i) {
    const TrackedScan& tracked = odometry.locate(scan.stamp, scan.coreScan().echoes);
    const Eigen::Isometry3d true_pose = scan.odom_from_base * scan.base_from_sensor;
    const Eigen::Isometry3d error =
        (truth.inverse() * true_pose).inverse() * found.inverse() * tracked.odom_from_sensor;
    if (i > 0) steps.push_back({tracked.status, error.translation().norm()});
    found = tracked.odom_from_sensor;
    truth = true_pose;
  }
  return steps;
}

TEST(OdometryInScenes, AMotorwayBetweenBarriersIsSaidToBeOpen) {
  for (const int seed : {1U, 2U, 3U}) {
    const std::vector<Step> steps = stepsIn("motorway", seed);
    ASSERT_EQ(steps.size(), kScans - 1U);
    int said = 0;
    for (const Step& step : steps) said += step.status == TrackingStatus::kDegenerate ? 1 : 0;
    EXPECT_GE(said, kScans - 2) << "seed " << seed;
  }
}

TEST(OdometryInScenes, WhatLittleTheOpenCountryHoldsIsEnough) {
  for (const char* scene : {"oncoming", "corners", "far_people", "bridges"}) {
    const std::vector<Step> steps = stepsIn(scene, 1);
    ASSERT_EQ(steps.size(), kScans - 1U);
    for (const Step& step : steps) {
      const bool is_known = step.status == TrackingStatus::kTracking || step.status == TrackingStatus::kStarting;
      EXPECT_TRUE(is_known) << scene << ": " << describe(step.status);
      EXPECT_LT(step.error, 0.1) << scene;
    }
  }
}

}  // namespace
}  // namespace donex
