// Echo times in the units that drivers and converters write, told by what they span.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "ros/pipeline_rig.h"
#include "ros/time_unit.h"

namespace donex {
namespace {

using sensor_msgs::PointField;
using test::CloudBuilder;
using test::PipelineRig;

constexpr double kPeriod = 0.1;          // [s]
constexpr double kSpeed = 10.0;          // [m/s]
constexpr std::uint32_t kEchoes = 1000;  // a turn at 20 m

constexpr std::uint32_t kWild = 7;  // the echo with a wild time

struct Written {
  const char* name;
  std::uint8_t datatype;
  double per_turn;          ///< what the time of the turn's end is written as
  double since_1970 = 0.0;  ///< units per second, where times are absolute
  double wild = 0.0;        ///< as one echo's time is written; 0 for none

  double at(double stamp, double share) const {
    return since_1970 > 0.0 ? since_1970 * (stamp + share * kPeriod) : share * per_turn;
  }
};

/// A turn of a sensor at `kSpeed` along x, whose echoes lie at 20 m straight ahead at the stamp.
boost::shared_ptr<sensor_msgs::PointCloud2> turn(const Written& written, double stamp) {
  auto cloud = CloudBuilder().stamp(stamp).xyz().field(written.name, written.datatype).size(kEchoes);
  for (std::uint32_t i = 0; i < kEchoes; ++i) {
    const double share = static_cast<double>(i) / kEchoes;
    cloud.at(i, 20.0 - kSpeed * share * kPeriod, 0.0, 1.0).set(i, written.name, written.at(stamp, share));
  }
  if (written.wild != 0.0) cloud.set(kWild, written.name, written.wild);
  return cloud.build();
}

/// Clouds of a drive, the last one labelled.
struct Drive {
  explicit Drive(const Written& written, const Config& config = test::smallConfig()) : rig(config) {
    for (int i = -10; i < 80; ++i) rig.odometry(100.0 + 0.01 * i, kSpeed);
    for (int i = 0; i < 6; ++i) {
      const double stamp = 100.0 + kPeriod * i;
      rig.pipeline.addCloud(turn(written, stamp), stamp);
      rig.run(stamp);
    }
    rig.pipeline.finish();
  }

  /// How far the echoes of the last cloud are from where they were at its stamp [m].
  double worst() const {
    double worst = 0.0;
    const auto& echoes = rig.labeled.back().echoes;
    for (std::size_t i = 0; i < echoes.size(); ++i) {
      if (i != kWild) worst = std::max(worst, std::abs(static_cast<double>(echoes[i].x()) - 20.0));
    }
    return worst;
  }

  PipelineRig rig;
};

class Unit : public testing::TestWithParam<Written> {};

TEST_P(Unit, IsFoundAndTheEchoesAreStraightened) {
  const Drive drive(GetParam());
  EXPECT_TRUE(drive.rig.drops.empty()) << drive.rig.drops[0];
  ASSERT_EQ(drive.rig.labeled.size(), 6U);
  EXPECT_LT(drive.worst(), 1e-3) << "[m]; without de-skewing it is " << kSpeed * kPeriod;
}

INSTANTIATE_TEST_SUITE_P(
    OfDriversAndConverters, Unit,
    testing::Values(Written{"time", PointField::FLOAT32, 0.1}, Written{"time", PointField::FLOAT32, 1.0},
                    Written{"time", PointField::FLOAT32, 1e2}, Written{"time", PointField::FLOAT32, 1e5},
                    Written{"t", PointField::UINT32, 1e8}, Written{"t", PointField::UINT32, 1e5},
                    Written{"offset_time", PointField::UINT32, 1e5}, Written{"time_stamp", PointField::FLOAT32, 0.1},
                    Written{"time_offset_ns", PointField::UINT32, 1e8}, Written{"ts", PointField::INT32, 1e5},
                    Written{"t", PointField::FLOAT64, 0.1}, Written{"time", PointField::FLOAT64, 1e5},
                    Written{"timestamp", PointField::FLOAT64, 0.0, 1e6},
                    Written{"point_stamp", PointField::FLOAT64, 0.0, 1.0},
                    Written{"timestamp", PointField::FLOAT64, 1e5}));

class WildTime : public testing::TestWithParam<Written> {};

TEST_P(WildTime, NeitherDelaysNorDropsACloud) {
  const Drive drive(GetParam());
  EXPECT_TRUE(drive.rig.drops.empty()) << drive.rig.drops[0];
  EXPECT_TRUE(drive.rig.strange_times.empty()) << drive.rig.strange_times[0];
  ASSERT_EQ(drive.rig.labeled.size(), 6U);
  EXPECT_LT(drive.worst(), 1e-3) << "[m]; without de-skewing it is " << kSpeed * kPeriod;
  const test::Labeled& last = drive.rig.labeled.back();
  EXPECT_LE(last.last_echo, last.stamp + kPeriod) << "nothing waits for odometry after the scan";
  const auto& remarks = drive.rig.remarks;
  EXPECT_EQ(std::count(remarks.begin(), remarks.end(), "1, taken for the scan's nearest end"), 1);
}

INSTANTIATE_TEST_SUITE_P(InAnyEncoding, WildTime,
                         testing::Values(Written{"time", PointField::FLOAT32, 0.1, 0.0, 0.9},
                                         Written{"time", PointField::FLOAT32, 0.1, 0.0, 1e9},
                                         Written{"time", PointField::FLOAT32, 0.1, 0.0, std::nan("")},
                                         Written{"t", PointField::UINT32, 1e8, 0.0, 4e9},
                                         Written{"timestamp", PointField::FLOAT64, 0.0, 1.0, 5.0}));

TEST(TimesOfNoUse, AreSaidOnceWithTheFieldsThereAre) {
  const struct {
    Written written;
    const char* text;
  } kCases[]{{{"intensity", PointField::FLOAT32, 0.1}, "no times of echoes; fields: x y z intensity"},
             {{"time", PointField::FLOAT32, 0.0}, "all times in 'time' are alike; "},
             {{"time_of_day", PointField::FLOAT32, 17.0}, "'time_of_day' looks like echoes' times"}};
  for (const auto& [written, text] : kCases) {
    const Drive drive(written);
    ASSERT_EQ(drive.rig.not_deskewed.size(), 1U) << text;
    EXPECT_NE(drive.rig.not_deskewed[0].find(text), std::string::npos) << drive.rig.not_deskewed[0];
    EXPECT_NE(drive.rig.pipeline.deskewedBy().find(text), std::string::npos) << drive.rig.pipeline.deskewedBy();
  }
}

TEST(TimesOfUse, AreSaidAsWhatTheCloudsAreDeskewedBy) {
  const Drive drive({"t", PointField::UINT32, 1e5});
  EXPECT_TRUE(drive.rig.not_deskewed.empty());
  const std::string& text = drive.rig.pipeline.deskewedBy();
  for (const char* part : {"times in 't'", "microseconds", "as they are written"}) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  }
}

/// How far the echoes of the last of `labeled` from each frame are from where they were at its stamp [m].
double worstOf(const std::vector<test::Labeled>& labeled, const std::string& frame) {
  double worst = std::numeric_limits<double>::infinity();
  for (const test::Labeled& scan : labeled) {
    if (scan.published->header.frame_id != frame) continue;
    worst = 0.0;
    for (const auto& echo : scan.echoes) worst = std::max(worst, std::abs(static_cast<double>(echo.x()) - 20.0));
  }
  return worst;
}

/// Each sensor's field has a unit of its own; the second's clouds come half a turn after the first's.
TEST(TimesOfTwoSensors, DoNotConfuseEachOther) {
  const struct {
    Written front, rear;
  } kCases[]{{{"t", PointField::UINT32, 1e5}, {"t", PointField::UINT32, 1e8}},
             {{"time", PointField::FLOAT32, 1e2}, {"time", PointField::FLOAT32, 0.1}},
             {{"t", PointField::UINT32, 1e5}, {"timestamp", PointField::FLOAT64, 0.0, 1.0}}};
  for (const auto& sensors : kCases) {
    PipelineRig rig;
    for (const char* frame : {"front", "rear"}) {
      rig.tf.setTransform(test::transformAt(0.0, "base_link", frame, 0.0, 1.7), "test", true);
    }
    for (int i = -10; i < 80; ++i) rig.odometry(100.0 + 0.01 * i, kSpeed);
    for (int i = 0; i < 10; ++i) {
      const double stamp = 100.0 + 0.5 * kPeriod * i;
      const auto cloud = turn(i % 2 == 0 ? sensors.front : sensors.rear, stamp);
      cloud->header.frame_id = i % 2 == 0 ? "front" : "rear";
      rig.pipeline.addCloud(cloud, stamp);
      rig.run(stamp);
    }
    rig.pipeline.finish();
    EXPECT_EQ(rig.labeled.size(), 10U) << (rig.drops.empty() ? "" : rig.drops[0]);
    for (const char* frame : {"front", "rear"}) EXPECT_LT(worstOf(rig.labeled, frame), 1e-3) << "[m], " << frame;
    for (const char* part : {"'front': times in 't", "; 'rear': times in 't"}) {
      EXPECT_NE(rig.pipeline.deskewedBy().find(part), std::string::npos) << rig.pipeline.deskewedBy();
    }
  }
}

TEST(TimeUnit, TheConfigurationOverrules) {
  Config config = test::smallConfig();
  config.cloud.time_field = "t";
  config.cloud.time_encoding = TimeEncoding::kRelativeNanoseconds;
  const Drive drive({"t", PointField::UINT32, 1e5}, config);
  EXPECT_NEAR(drive.worst(), kSpeed * kPeriod, 0.01) << "microseconds read as nanoseconds, as was told";
}

std::string findingAfter(const std::vector<double>& stamps, const Written& written,
                         double wild = std::numeric_limits<double>::quiet_NaN()) {
  TimeUnit unit;
  for (const double stamp : stamps) {
    const auto cloud = turn(written, stamp);
    if (!std::isnan(wild)) {
      const std::size_t offset = 7 * cloud->point_step + 12;
      const auto value = static_cast<float>(wild);
      std::memcpy(&cloud->data[offset], &value, sizeof value);
    }
    CloudLayout layout = std::get<CloudLayout>(judgeLayout(*cloud));
    unit.observe(*cloud, layout);
  }
  return unit.finding();
}

const std::vector<double> kRegular{100.0, 100.1, 100.2, 100.3, 100.4};

TEST(TimeUnit, IsSaidWithItsFigures) {
  const std::string finding = findingAfter(kRegular, {"t", PointField::UINT32, 1e5});
  EXPECT_NE(finding.find("microseconds"), std::string::npos) << finding;
  EXPECT_NE(finding.find("0.1 s apart"), std::string::npos) << finding;
}

TEST(TimeUnit, NothingIsSaidOfTheUsualOne) {
  EXPECT_EQ(findingAfter(kRegular, {"t", PointField::UINT32, 1e8}), "");
  EXPECT_EQ(findingAfter(kRegular, {"time", PointField::FLOAT32, 0.1}), "");
}

TEST(TimeUnit, OneWildTimeIsOutvoted) {
  EXPECT_EQ(findingAfter(kRegular, {"time", PointField::FLOAT32, 0.1}, 1e5), "");
}

TEST(TimeUnit, LostCloudsAreOutvoted) {
  const std::vector<double> gaps{100.0, 100.1, 103.0, 103.1, 103.2, 190.0, 190.1};
  EXPECT_EQ(findingAfter(gaps, {"time", PointField::FLOAT32, 0.1}), "");
}

/// What spans neither a scan nor anything a thousand times as long is left as it is.
TEST(TimeUnit, WhatFitsNoUnitStaysUsual) {
  EXPECT_EQ(findingAfter(kRegular, {"t", PointField::UINT32, 1e3}), "");
  EXPECT_EQ(findingAfter(kRegular, {"t", PointField::UINT32, 0.0}), "");
}

}  // namespace
}  // namespace donex
