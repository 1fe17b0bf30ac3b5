// Every common LiDAR, as its driver publishes it and with its file of config/sensors: read, de-skewed, bytes kept.
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "donex/parameters.h"
#include "io/config_file.h"
#include "ros/driver_clouds.h"
#include "ros/pipeline_rig.h"

namespace donex {
namespace {

using test::DriverCloud;
using test::kSpeed;
using test::kStart;
using test::kTurn;
using test::PipelineRig;
using test::PointCloud2;

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
    {"hap", "livox"},        {"livox_custom", "livox custom"},
};

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

TEST(Sensors, EveryFileIsTriedWithItsDriver) {
  std::set<std::string> files, tried;
  for (const auto& entry : std::filesystem::directory_iterator(kSensors)) files.insert(entry.path().stem());
  for (const auto& [sensor, driver] : kDriverOf) tried.insert(sensor);
  EXPECT_EQ(files, tried);
}

/// How the clouds are read, how far the sensor reaches, and the gap between its beams: nothing else that shapes labels.
TEST(Sensors, FilesSayOnlyWhatASensorIs) {
  const std::vector<Parameter> defaults = parametersOf(Config());
  for (const auto& entry : std::filesystem::directory_iterator(kSensors)) {
    const std::vector<Parameter> values = parametersOf(readConfigFile(entry.path()));
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto& [info, value] = values[i];
      const bool is_of_sensor = info.group == ParameterGroup::kClouds || info.group == ParameterGroup::kRegion ||
                                std::string(info.name) == "sight_gap";
      EXPECT_TRUE(is_of_sensor || value == defaults[i].value) << entry.path() << ": " << info.name;
    }
  }
}

TEST(Sensors, ScansAreStraightened) {
  for (const auto& [sensor, name] : kDriverOf) {
    SCOPED_TRACE(sensor + ", " + name);
    const DriverCloud& driver = test::driverNamed(name);
    PipelineRig rig(configFor(sensor));
    for (int i = -30; i < 30; ++i) rig.pipeline.addOdometry(odometryAfter(0.01 * i));
    rig.pipeline.addCloud(distortedScan(driver), stampOf(driver));
    rig.run(stampOf(driver));
    ASSERT_EQ(rig.labeled.size(), 1U) << (rig.drops.empty() ? "" : rig.drops[0]);
    EXPECT_TRUE(rig.strange_times.empty()) << rig.strange_times[0];
    expectStraightened(rig.labeled[0].echoes);
  }
}

TEST(Sensors, TheDriversBytesAndFieldsAreKept) {
  for (const DriverCloud& driver : test::driverClouds()) {
    SCOPED_TRACE(driver.driver);
    const auto cloud = distortedScan(driver);
    const PointCloud2 sent = *cloud;
    ASSERT_EQ(sent.point_step, driver.point_step);
    PipelineRig rig;
    for (int i = -30; i < 30; ++i) rig.pipeline.addOdometry(odometryAfter(0.01 * i));
    rig.pipeline.addCloud(cloud, stampOf(driver));
    rig.run(stampOf(driver));
    ASSERT_EQ(rig.labeled.size(), 1U) << (rig.drops.empty() ? "" : rig.drops[0]);
    const auto out = rig.labeled[0].published;
    EXPECT_TRUE(*cloud == sent) << "other subscribers have the same object";
    ASSERT_EQ(out->fields.size(), sent.fields.size() + 2);
    EXPECT_TRUE(std::equal(sent.fields.begin(), sent.fields.end(), out->fields.begin()));
    EXPECT_EQ(out->height, driver.rows);
    for (std::size_t i = 0; i < kEchoes; ++i) {
      ASSERT_EQ(std::memcmp(&sent.data[i * sent.point_step], &out->data[i * out->point_step], sent.point_step), 0);
    }
  }
}

TEST(Sensors, ADriverWithoutTimesIsToldOf) {
  PipelineRig rig(configFor("rs16"));
  rig.odometry(100.0);
  rig.cloud(100.0);
  rig.run(100.0);
  EXPECT_EQ(rig.labeled.size(), 1U) << "labelled all the same";
  ASSERT_EQ(rig.strange_times.size(), 1U);
  EXPECT_NE(rig.strange_times[0].find("'timestamp'"), std::string::npos) << rig.strange_times[0];
}

/// Two LiDARs' clouds merged into one frame, 1.7 m above the vehicle's and 0.5 m before it; the one that is named sits
/// 4 m to the left of that frame's origin, in front of a wall. `far` is seen past the wall.
constexpr double kNamedOrigin = 4.0;                      // [m]
const Eigen::Vector3f kBehindTheWall(8.0F, 4.0F, 0.0F);   // on the line from the frame's origin to `far`
const Eigen::Vector3f kBesideTheWall(8.0F, 5.33F, 0.0F);  // on the line from the named origin to `far`

std::vector<Eigen::Vector3f> wallAndFar() {
  std::vector<Eigen::Vector3f> echoes;
  for (int i = -5; i <= 5; ++i) {
    const float aside = 0.1F * static_cast<float>(i);
    echoes.emplace_back(5.0F, 4.0F + aside, 0.0F);
    echoes.emplace_back(12.0F, 6.0F + aside, 0.0F);
  }
  return echoes;
}

/// Scans of wall and far, then one more with echoes behind and beside the wall, which come last.
test::Labeled lastOfMergedScans(const CloudConfig& cloud) {
  constexpr int kScans = 8;
  Config config = test::smallConfig();
  config.cloud = cloud;
  config.evidence.ground = false;
  PipelineRig rig(config, false);
  rig.tf.setTransform(test::transformAt(0.0, "base_link", "merged", 0.5, 1.7), "test", true);
  auto echoes = wallAndFar();
  for (int i = 0; i <= kScans; ++i) {
    const double stamp = 100.0 + 0.1 * i;
    if (i == kScans) echoes.insert(echoes.end(), {kBehindTheWall, kBesideTheWall});
    rig.odometry(stamp);
    rig.pipeline.addCloud(test::plainCloud(echoes, stamp, "merged"), stamp);
    rig.run(stamp);
  }
  EXPECT_EQ(rig.labeled.size(), kScans + 1U);
  return rig.labeled.back();
}

TEST(Sensors, LinesOfSightBeginAtTheConfiguredOrigin) {
  CloudConfig cloud;
  cloud.origin_y = kNamedOrigin;
  const test::Labeled scan = lastOfMergedScans(cloud);
  EXPECT_TRUE(scan.base_from_sensor.translation().isApprox(Eigen::Vector3d(0.5, kNamedOrigin, 1.7)));
  const Eigen::Vector3f moved = kBesideTheWall - Eigen::Vector3f(0.0F, static_cast<float>(kNamedOrigin), 0.0F);
  EXPECT_TRUE(scan.echoes.back().isApprox(moved));
  EXPECT_EQ(*(scan.labels.observed.end() - 2), 0) << "behind the wall nothing was seen free";
  EXPECT_EQ(scan.labels.observed.back(), 1) << "the sensor saw past the wall";
}

TEST(Sensors, LinesOfSightBeginInTheFramesOriginUnlessToldOtherwise) {
  const test::Labeled scan = lastOfMergedScans({});
  EXPECT_EQ(*(scan.labels.observed.end() - 2), 1) << "from there it is in front of what is far";
  EXPECT_EQ(scan.labels.observed.back(), 0) << "from there nobody looked past it";
}

/// Several LiDARs on one topic: each cloud's lines of sight begin where its own frame is.
TEST(Sensors, EachCloudHasTheOriginOfItsFrame) {
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
