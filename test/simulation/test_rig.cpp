// Several sensors on one vehicle: each in its place, all at the same times, in the same scene.
#include <algorithm>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "simulation/same_scan.h"
#include "simulation/simulator.h"

namespace donex::simulation {
namespace {

SimulatorOptions optionsOf(const std::string& rig, bool distortion = false) {
  SimulatorOptions options;
  options.rig = rig;
  options.beams = 16;
  options.distortion = distortion;
  options.duration = 0.5;
  return options;
}

class EveryRig : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Rigs, EveryRig, testing::ValuesIn(rigNames()));

TEST_P(EveryRig, ItsSensorsMeasureAtTheSameTimes) {
  Simulator simulator("street", optionsOf(GetParam()));
  const std::size_t sensors = findRig(GetParam())->mountings.size();
  ASSERT_EQ(simulator.sensorCount(), sensors);
  ASSERT_EQ(simulator.size(), 5U * sensors);
  std::set<std::string> names;
  for (std::size_t i = 0; i < simulator.size(); ++i) {
    SimulatedScan scan;
    ASSERT_TRUE(simulator.next(scan));
    const std::size_t sensor = i % sensors;
    EXPECT_NEAR(scan.stamp, 0.1 * static_cast<double>(i / sensors + 1), 1e-9);
    EXPECT_EQ(scan.sensor, simulator.sensorName(sensor));
    EXPECT_EQ(scan.base_from_sensor.matrix(), simulator.baseFromSensor(sensor).matrix());
    EXPECT_EQ(scan.odometry.empty(), sensor != 0);
    EXPECT_GT(scan.echoes.size(), 5000U);
    names.insert(scan.sensor);
  }
  EXPECT_EQ(names.size(), sensors);
}

/// Walked with each sensor's own mounting, so a wrong one would put them elsewhere.
TEST_P(EveryRig, MovingEchoesLieInsideTheirThingsSeenFromEachSensor) {
  constexpr double kMargin = 0.075;  // [m] five deviations of the range
  for (const bool distortion : {false, true}) {
    SimulatorOptions options = optionsOf(GetParam(), distortion);
    options.beams = 64;
    options.parts = distortion ? 4 : 1;
    Simulator simulator("intersection", options);
    std::map<std::string, int> moving;
    SimulatedScan scan;
    while (simulator.next(scan)) {
      for (std::size_t i = 0; i < scan.echoes.size(); i += 2) {
        const std::uint32_t instance = scan.labels[i] >> 16;
        if (instance == 0) continue;
        const double time = scan.stamp + static_cast<double>(scan.echoes[i].time);
        const MoverTruth truth = simulator.mover(instance - 1, time);
        const Eigen::Isometry3d odom_from_sensor = simulator.odomFromBase(time) * scan.base_from_sensor;
        const Eigen::Vector3d point = odom_from_sensor * scan.echoes[i].position.cast<double>();
        const Eigen::Vector3d local = truth.odom_from_box.inverse() * point;
        EXPECT_LT((local.cwiseAbs() - 0.5 * truth.size).maxCoeff(), kMargin) << scan.sensor << ' ' << truth.label;
        ++moving[scan.sensor];
      }
    }
    EXPECT_EQ(moving.size(), simulator.sensorCount());
    for (const auto& [sensor, echoes] : moving) EXPECT_GT(echoes, 50) << sensor;
  }
}

TEST_P(EveryRig, SensorsOfHalfATurnSeeOnlyWhatIsAheadOfThem) {
  Simulator simulator("street", optionsOf(GetParam(), true));
  SimulatedScan scan;
  for (const Mounting& mounting : findRig(GetParam())->mountings) {
    ASSERT_TRUE(simulator.next(scan));
    const auto is_ahead = [](const SimulatedEcho& echo) { return echo.position.x() >= 0.0F; };
    EXPECT_EQ(std::all_of(scan.echoes.begin(), scan.echoes.end(), is_ahead), mounting.sees_half) << scan.sensor;
    EXPECT_EQ(scan.base_from_sensor.linear()(0, 0) < 0.0, mounting.faces_back) << scan.sensor;
  }
}

TEST_P(EveryRig, TheSameSeedGivesTheSameScans) {
  Simulator first("crowd", optionsOf(GetParam()));
  Simulator again("crowd", optionsOf(GetParam()));
  SimulatedScan a, b;
  while (first.next(a)) {
    ASSERT_TRUE(again.next(b));
    EXPECT_TRUE(sameScan(a, b));
  }
}

TEST(Rig, TheSensorOnTheRoofMeasuresWhatItMeasuresAlone) {
  Simulator alone("street", optionsOf("single"));
  Simulator rig("street", optionsOf("roof_front_rear"));
  SimulatedScan a, b;
  while (alone.next(a)) {
    ASSERT_TRUE(rig.next(b));
    EXPECT_EQ(b.sensor, "roof");
    EXPECT_TRUE(sameScan(a, b));
    for (int others = 0; others < 2; ++others) ASSERT_TRUE(rig.next(b));
  }
}

TEST(Rig, APatternThatNeverRepeatsHasAnotherPhaseInEachSensor) {
  SimulatorOptions options = optionsOf("front_rear");
  options.beams = 0;
  options.pattern = "avia";
  Simulator simulator("street", options);
  SimulatedScan front, rear;
  ASSERT_TRUE(simulator.next(front) && simulator.next(rear));
  const Eigen::Vector3f first = front.echoes.front().position.normalized();
  EXPECT_GT((first - rear.echoes.front().position.normalized()).norm(), 1e-3F);
}

TEST(Rig, WhatDoesNotGoWithSeveralSensorsIsRefused) {
  SimulatorOptions options = optionsOf("front_back");
  std::vector<std::string> expected{"rig is 'front_back'; there are: single front_rear roof_bumper roof_front_rear"};
  EXPECT_EQ(options.faults(), expected);
  options = optionsOf("roof_bumper");
  expected = {"empty_room has one sensor and no vehicle: not with a rig of several"};
  EXPECT_EQ(faultsOf("empty_room", options), expected);
  options.disturbance.own_body = true;
  expected = {"own_body, dust and spray are as one sensor on the roof sees them: not with a rig of several"};
  EXPECT_EQ(options.faults(), expected);
  options = optionsOf("roof_bumper");
  options.parts = 4;
  expected = {"parts without distortion are sectors all around, where these sensors do not look: add distortion"};
  EXPECT_EQ(options.faults(), expected);
}

}  // namespace
}  // namespace donex::simulation
