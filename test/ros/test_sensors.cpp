// Every common LiDAR, as its driver publishes it and with its file of config/sensors: read, de-skewed, bytes kept.
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "donex/io/config_file.h"
#include "ros/driver_clouds.h"
#include "ros/pipeline_rig.h"

namespace donex {
namespace {

using test::DriverCloud;
using test::PipelineRig;
using test::PointCloud2;

constexpr double kStart = 1700000000.25;  // of the scan [s]
constexpr double kTurn = 0.1;             // [s]
constexpr double kSpeed = 15.0;           // [m/s]
constexpr std::uint32_t kEchoes = 640;
constexpr std::uint32_t kNothing = 7;  // every so many-th ray comes back with nothing

const std::filesystem::path kSensors = std::filesystem::path(DONEX_CONFIG_DIR) / "sensors";

/// Which driver a sensor is used with.
const std::multimap<std::string, std::string> kDriverOf{
    {"vlp16", "velodyne"},   {"vlp16", "velodyne organised"},
    {"hdl32e", "velodyne"},  {"hdl64e", "velodyne"},
    {"vls128", "velodyne"},  {"os0", "ouster"},
    {"os1", "ouster"},       {"os1", "ouster ring 8"},
    {"os2", "ouster"},       {"pandar", "hesai general"},
    {"xt32", "hesai 2.0"},   {"rs16", "robosense"},
    {"rs32", "robosense"},   {"ruby", "robosense"},
    {"bpearl", "robosense"}, {"mid360", "livox"},
    {"hap", "livox"},
};

const DriverCloud& driverNamed(const std::string& name) {
  for (const DriverCloud& cloud : test::driverClouds()) {
    if (cloud.driver == name) return cloud;
  }
  throw std::invalid_argument(name);
}

/// When ray `i` was fired, after the scan's start [s].
double firedAfter(std::size_t i) { return kTurn * static_cast<double>(i) / (kEchoes - 1); }

double stampOf(const DriverCloud& driver) {
  return driver.stamped_at == test::StampedAt::kFirstEcho ? kStart : kStart + kTurn;
}

/// Where ray `i` ends, seen from where the sensor is at the cloud's stamp [m].
Eigen::Vector3d target(std::size_t i) {
  const double angle = 2.0 * M_PI * firedAfter(i) / kTurn;
  return {12.0 * std::cos(angle), 12.0 * std::sin(angle), 0.5};
}

/// A scan of a vehicle that drives at kSpeed along x, as the driver publishes it.
boost::shared_ptr<PointCloud2> distortedScan(const DriverCloud& driver) {
  const double stamp = stampOf(driver);
  auto builder = test::builderOf(driver, kEchoes, stamp);
  for (std::size_t i = 0; i < kEchoes; ++i) {
    const double fired = kStart + firedAfter(i), after = fired - stamp;
    const Eigen::Vector3d seen = target(i) - Eigen::Vector3d(kSpeed * after, 0.0, 0.0);
    const bool nothing = i % kNothing == 0;
    if (nothing) {
      builder.at(i, driver.no_return, driver.no_return, driver.no_return);
    } else {
      builder.at(i, seen.x(), seen.y(), seen.z());
    }
    builder.set(i, driver.time_field, driver.units_per_second * (driver.absolute ? fired : after));
  }
  return builder.build();
}

/// The vehicle `after` the scan's start [s].
nav_msgs::Odometry odometryAfter(double after) {
  nav_msgs::Odometry odometry = test::odometryAt(kStart + after);
  odometry.pose.pose.position.x = kSpeed * after;
  return odometry;
}

Config configFor(const std::string& sensor) { return readConfigFile(kSensors / (sensor + ".yaml")); }

void expectStraightened(const std::vector<Eigen::Vector3f>& echoes) {
  ASSERT_EQ(echoes.size(), kEchoes);
  double worst = 0.0;
  for (std::size_t i = 0; i < kEchoes; ++i) {
    if (i % kNothing == 0) {
      EXPECT_FALSE(echoes[i].allFinite()) << "ray " << i << " came back with nothing";
    } else {
      worst = std::max(worst, (echoes[i].cast<double>() - target(i)).norm());
    }
  }
  EXPECT_LT(worst, 1e-4) << "[m]; without de-skewing it is " << kSpeed * kTurn;
}

TEST(Sensors, everyFileIsTriedWithItsDriver) {
  std::set<std::string> files, tried;
  for (const auto& entry : std::filesystem::directory_iterator(kSensors)) files.insert(entry.path().stem());
  for (const auto& [sensor, driver] : kDriverOf) tried.insert(sensor);
  EXPECT_EQ(files, tried);
}

TEST(Sensors, scansAreStraightened) {
  for (const auto& [sensor, name] : kDriverOf) {
    SCOPED_TRACE(sensor + ", " + name);
    const DriverCloud& driver = driverNamed(name);
    PipelineRig rig(configFor(sensor));
    for (int i = -30; i < 30; ++i) rig.pipeline.addOdometry(odometryAfter(0.01 * i));
    rig.pipeline.addCloud(distortedScan(driver), stampOf(driver));
    rig.run(stampOf(driver));
    ASSERT_EQ(rig.labeled.size(), 1U) << (rig.drops.empty() ? "" : rig.drops[0]);
    EXPECT_TRUE(rig.strange_times.empty()) << rig.strange_times[0];
    expectStraightened(rig.labeled[0].echoes);
  }
}

TEST(Sensors, theDriversBytesAndFieldsAreKept) {
  for (const DriverCloud& driver : test::driverClouds()) {
    SCOPED_TRACE(driver.driver);
    const auto cloud = distortedScan(driver);
    ASSERT_EQ(cloud->point_step, driver.point_step);
    const CloudLayout layout = std::get<CloudLayout>(judgeLayout(*cloud));
    EchoLabels labels;
    labels.assign(kEchoes);
    const auto out = labelCloud(*cloud, layout, labels);
    ASSERT_EQ(out->fields.size(), cloud->fields.size() + 2);
    EXPECT_TRUE(std::equal(cloud->fields.begin(), cloud->fields.end(), out->fields.begin()));
    EXPECT_EQ(out->height, driver.rows);
    for (std::size_t i = 0; i < kEchoes; ++i) {
      ASSERT_EQ(std::memcmp(&cloud->data[i * cloud->point_step], &out->data[i * out->point_step], cloud->point_step),
                0);
    }
  }
}

TEST(Sensors, aDriverWithoutTimesIsToldOf) {
  PipelineRig rig(configFor("rs16"));
  rig.odometry(100.0);
  rig.cloud(100.0);
  rig.run(100.0);
  EXPECT_EQ(rig.labeled.size(), 1U) << "labelled all the same";
  ASSERT_EQ(rig.strange_times.size(), 1U);
  EXPECT_NE(rig.strange_times[0].find("'timestamp'"), std::string::npos) << rig.strange_times[0];
}

/// Two LiDARs' clouds merged into the vehicle's frame: what hides behind the wall in front of the sensor that is
/// named stays unobserved only if lines of sight begin at it.
TEST(Sensors, linesOfSightBeginAtTheConfiguredOrigin) {
  Config config = test::smallConfig();
  config.cloud.origin_x = 2.0;
  config.cloud.origin_z = 1.7;
  PipelineRig rig(config, false);
  rig.tf.setTransform(test::transformAt(0.0, "base_link", "merged", 0.5), "test", true);
  rig.odometry(100.0);
  rig.pipeline.addCloud(test::plainCloud({{5.0F, 1.0F, 1.7F}}, 100.0, "merged"), 100.0);
  rig.run(100.0);
  ASSERT_EQ(rig.labeled.size(), 1U);
  EXPECT_TRUE(rig.labeled[0].base_from_sensor.translation().isApprox(Eigen::Vector3d(2.5, 0.0, 1.7)));
  EXPECT_TRUE(rig.labeled[0].echoes[0].isApprox(Eigen::Vector3f(3.0F, 1.0F, 0.0F)));
}

/// Several LiDARs on one topic: each cloud's lines of sight begin where its own frame is.
TEST(Sensors, eachCloudHasTheOriginOfItsFrame) {
  PipelineRig rig(test::smallConfig(), false);
  rig.tf.setTransform(test::transformAt(0.0, "base_link", "left", 1.0, 1.7), "test", true);
  rig.tf.setTransform(test::transformAt(0.0, "base_link", "right", -1.0, 1.9), "test", true);
  for (const double stamp : {100.0, 100.05, 100.1, 100.15}) rig.odometry(stamp);
  for (int i = 0; i < 4; ++i) {
    const double stamp = 100.0 + 0.05 * i;
    rig.pipeline.addCloud(test::plainCloud(test::ring(), stamp, i % 2 == 0 ? "left" : "right"), stamp);
  }
  rig.run(100.2);
  ASSERT_EQ(rig.labeled.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(rig.labeled[i].base_from_sensor.translation().x(), i % 2 == 0 ? 1.0 : -1.0);
  }
}

}  // namespace
}  // namespace donex
