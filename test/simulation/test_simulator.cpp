#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "simulation/same_scan.h"
#include "simulation/sensor_model.h"
#include "simulation/simulator.h"

namespace donex::simulation {
namespace {

TEST(Simulator, SameSeedSameScansOtherSeedOthers) {
  SimulatorOptions options;
  options.beams = 16;
  Simulator first("street", options);
  Simulator again("street", options);
  options.seed = 2;
  Simulator other("street", options);
  for (int k = 0; k < 5; ++k) {
    SimulatedScan a, b, c;
    ASSERT_TRUE(first.next(a) && again.next(b) && other.next(c));
    EXPECT_TRUE(sameScan(a, b));
    EXPECT_FALSE(sameScan(a, c));
    ASSERT_EQ(a.odometry.size(), b.odometry.size());
    for (std::size_t i = 0; i < a.odometry.size(); ++i) {
      EXPECT_EQ(a.odometry[i].odom_from_base.matrix(), b.odometry[i].odom_from_base.matrix());
    }
  }
}

TEST(Simulator, DenseSensorsHaveManyEchoes) {
  for (const char* scene : {"intersection", "street", "motorway", "bend"}) {
    for (const int beams : {64, 128}) {
      SimulatorOptions options;
      options.beams = beams;
      Simulator simulator(scene, options);
      SimulatedScan scan;
      for (int k = 0; k < 4; ++k) {
        ASSERT_TRUE(simulator.next(scan));
        EXPECT_GE(scan.echoes.size(), 120000U) << scene << ' ' << beams;
      }
    }
  }
}

TEST(Simulator, EchoesAreWithinRangeAndOnTheirBeams) {
  for (const int beams : {16, 32, 64, 128}) {
    SimulatorOptions options;
    options.beams = beams;
    options.max_range = 40.0;
    options.distortion = true;
    const SensorModel model = makeSensorModel(beams);
    Simulator simulator("street", options);
    SimulatedScan scan;
    ASSERT_TRUE(simulator.next(scan));
    ASSERT_EQ(scan.labels.size(), scan.echoes.size());
    EXPECT_EQ(simulator.beams(), beams);
    EXPECT_GT(scan.echoes.size(), 10000U);
    for (const SimulatedEcho& echo : scan.echoes) {
      ASSERT_LE(echo.position.norm(), 40.001f);
      ASSERT_GE(echo.position.norm(), model.min_range - 0.001f);
      ASSERT_LT(echo.ring, beams);
      ASSERT_NEAR(echo.position.z() / echo.position.head<2>().norm(), model.slopes[echo.ring], 1e-4f);
      ASSERT_GE(echo.intensity, 0.0f);
      ASSERT_LE(echo.intensity, 1.0f);
      ASSERT_LT(echo.time, 0.0f);
      ASSERT_GT(echo.time, -0.1f);
    }
  }
}

TEST(Simulator, EndsAfterItsDurationAndGoesOnWithoutOne) {
  SimulatorOptions options;
  options.beams = 16;
  options.duration = 1.0;
  options.start_stamp = 50.0;
  Simulator simulator("empty_room", options);
  EXPECT_EQ(simulator.size(), 10U);
  SimulatedScan scan;
  for (int k = 1; k <= 10; ++k) {
    ASSERT_TRUE(simulator.next(scan));
    EXPECT_NEAR(scan.stamp, 50.0 + 0.1 * k, 1e-9);
    EXPECT_EQ(scan.echoes.front().time, 0.0f);
  }
  EXPECT_FALSE(simulator.next(scan));
  EXPECT_NEAR(scan.stamp, 51.0, 1e-9);

  options.duration = 0.0;
  Simulator endless("empty_room", options);
  for (int k = 0; k < 15; ++k) ASSERT_TRUE(endless.next(scan));
}

TEST(Simulator, OdometryComesInItsOwnRhythmAndCoversEveryScan) {
  for (const double rate : {7.0, 50.0, 100.0}) {
    SimulatorOptions options;
    options.beams = 16;
    options.odometry = OdometryOptions::exact();
    options.odometry.rate = rate;
    options.start_stamp = 10.0;
    Simulator simulator("standstill_start", options);
    SimulatedScan scan;
    double first = 0.0;
    double last = 0.0;
    int samples = 0;
    for (int k = 0; k < 20; ++k) {
      ASSERT_TRUE(simulator.next(scan));
      for (const OdometrySample& sample : scan.odometry) {
        const double expected = samples == 0 ? sample.stamp : last + 1.0 / rate;
        EXPECT_NEAR(sample.stamp, expected, 1e-9);
        last = sample.stamp;
        ++samples;
        EXPECT_LE(sample.stamp, scan.stamp + 1e-6);
        EXPECT_TRUE(sample.odom_from_base.isApprox(simulator.odomFromBase(sample.stamp), 1e-6));
      }
      EXPECT_GT(last, scan.stamp - 1.0 / rate - 1e-6);
      first = k == 0 ? scan.odometry.front().stamp : first;
    }
    EXPECT_LE(first, 10.0);  // the beginning of the first turn
    EXPECT_NEAR(samples, rate * 2.0, 0.1 * rate + 2.0);
  }
}

TEST(Simulator, OdometryCoversTheFirstScanWhateverItsStampsAreMovedBy) {
  for (const double offset : {-1.0, 0.0, 0.1, 0.7, 1.0}) {
    for (const double rate : {1.0, 7.0, 50.0}) {
      SimulatorOptions options;
      options.beams = 16;
      options.odometry.rate = rate;
      options.odometry.stamp_offset = offset;
      Simulator simulator("standstill_start", options);
      SimulatedScan scan;
      ASSERT_TRUE(simulator.next(scan));
      ASSERT_FALSE(scan.odometry.empty());
      EXPECT_EQ(scan.odometry.front().stamp, options.odometry.firstStamp());
      EXPECT_LE(scan.odometry.front().stamp, 1e-9) << "offset " << offset << ", rate " << rate;
    }
  }
}

TEST(Simulator, TwistIsTheDerivativeOfThePose) {
  SimulatorOptions options;
  options.beams = 16;
  options.odometry = OdometryOptions::exact();
  options.odometry.rate = 100.0;
  Simulator simulator("bend", options);
  SimulatedScan scan;
  for (int k = 0; k < 30; ++k) {
    simulator.next(scan);
    for (std::size_t i = 1; i < scan.odometry.size(); ++i) {
      const OdometrySample& before = scan.odometry[i - 1];
      const Eigen::Isometry3d moved = before.odom_from_base * integrateTwist(before.twist, 0.01);
      EXPECT_LT((moved.translation() - scan.odometry[i].odom_from_base.translation()).norm(), 2e-3);
    }
  }
}

TEST(Simulator, BeginsAtTheOriginOfItsOdometry) {
  for (const std::string& scene : sceneNames()) {
    SimulatorOptions options;
    options.beams = 16;
    const Simulator simulator(scene, options);
    const Eigen::Isometry3d start = simulator.odomFromBase(0.0);
    EXPECT_LT(start.translation().norm(), 1e-9) << scene;
    EXPECT_NEAR(std::atan2(start.linear()(1, 0), start.linear()(0, 0)), 0.0, 1e-9) << scene;
    EXPECT_GT(start.linear()(2, 2), 0.99) << scene;
  }
}

TEST(Simulator, NamesEveryFault) {
  SimulatorOptions options;
  options.beams = 48;
  options.dropout = -0.5;
  options.odometry.rate = NAN;
  try {
    const Simulator simulator("stret", options);
    FAIL();
  } catch (const std::invalid_argument& error) {
    for (const char* part : {"beams", "48", "dropout", "odometry_rate", "stret", "street"}) {
      EXPECT_NE(std::strstr(error.what(), part), nullptr) << part << " is not in: " << error.what();
    }
  }
  EXPECT_TRUE(SimulatorOptions().faults().empty());
}

TEST(Simulator, ADurationHoldsAtLeastAScan) {
  SimulatorOptions options;
  options.duration = 0.05;
  const std::vector<std::string> expected{"duration is 0.05 s, shorter than a scan, which takes 0.1 s"};
  EXPECT_EQ(options.faults(), expected);
  options.scan_rate = 20.0;
  EXPECT_TRUE(options.faults().empty());
  EXPECT_EQ(options.turns(), 1U);
}

TEST(SimulatedScan, IsTakenByTheCoreWithItsTrueMotion) {
  SimulatorOptions options;
  options.beams = 16;
  Simulator simulator("bend", options);
  SimulatedScan scan;
  simulator.next(scan);
  const Scan core = scan.coreScan();
  ASSERT_EQ(core.echoes.size(), scan.echoes.size());
  EXPECT_EQ(core.echoes[100], scan.echoes[100].position);
  EXPECT_EQ(core.stamp, scan.stamp);
  EXPECT_EQ(core.odom_from_base.matrix(), simulator.odomFromBase(scan.stamp).matrix());
}

}  // namespace
}  // namespace donex::simulation
