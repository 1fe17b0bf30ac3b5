// What the simulated vehicle sends, read back.
#include <gtest/gtest.h>

#include "ros/conversions.h"
#include "simulated_lidar/simulation_messages.h"

namespace donex {
namespace {

using simulation::SimulatedScan;

SimulatedScan scanOf(bool distortion, double start_stamp) {
  simulation::SimulatorOptions options;
  options.beams = 16;
  options.distortion = distortion;
  options.start_stamp = start_stamp;
  simulation::Simulator simulator("street", options);
  SimulatedScan scan;
  EXPECT_TRUE(simulator.next(scan));
  return scan;
}

TEST(SimulationMessages, ADistortedScanHasItsTimes) {
  const SimulatedScan scan = scanOf(true, 5.0);
  const auto cloud = toCloud(scan, {});
  EXPECT_EQ(cloud->header.stamp.toSec(), 5.1);
  const CloudLayout layout = std::get<CloudLayout>(judgeLayout(*cloud));
  std::vector<Eigen::Vector3f> echoes;
  EchoTimes times;
  parseEchoes(*cloud, layout, echoes, times);
  ASSERT_EQ(times.after_stamp.size(), scan.echoes.size()) << times.problem;
  EXPECT_LT(times.first, -0.09);
  EXPECT_LE(times.last, 0.0);
  for (std::size_t i = 0; i < echoes.size(); i += 100) {
    EXPECT_EQ(echoes[i], scan.echoes[i].position);
    EXPECT_EQ(times.after_stamp[i], scan.echoes[i].time);
  }
}

TEST(SimulationMessages, OdometryOfEveryStart) {
  for (const double start : {1.0, 5.0, 1.7e9}) {
    for (const OdometrySample& sample : scanOf(true, start).odometry) {
      const auto odometry = toOdometry(sample, {});
      const auto transform = toTransform(sample, {});
      EXPECT_NEAR(odometry->header.stamp.toSec(), sample.stamp, 1e-6);
      EXPECT_EQ(transform.header.stamp, odometry->header.stamp);
      EXPECT_EQ(odometry->pose.pose.position.x, sample.odom_from_base.translation().x());
    }
  }
}

TEST(SimulationMessages, ThereIsNoRosTimeBeforeTheEpoch) {
  const SimulatedScan scan = scanOf(false, 0.0);
  ASSERT_LT(scan.odometry.front().stamp, 0.0) << "odometry begins before the scene does";
  EXPECT_THROW(toOdometry(scan.odometry.front(), {}), std::runtime_error);
}

}  // namespace
}  // namespace donex
