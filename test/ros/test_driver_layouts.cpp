// Layouts that differ within a driver's family: Ouster's organised clouds of any height, Livox's without times.
#include <cmath>

#include <gtest/gtest.h>

#include "ros/driver_clouds.h"
#include "ros/pipeline_rig.h"

namespace donex {
namespace {

using test::DriverCloud;
using test::kSpeed;
using test::kStart;
using test::kTurn;
using test::PipelineRig;
using test::PointField;

constexpr std::uint32_t kColumns = 64;

/// Rows of an organised cloud, and what its driver writes where nothing came back.
struct OusterCase {
  std::uint32_t rows;
  double no_return;
};

class Ouster : public testing::TestWithParam<OusterCase> {
 protected:
  std::uint32_t rows() const { return GetParam().rows; }
  std::size_t echoes() const { return std::size_t{rows()} * kColumns; }

  /// All rows of a column are fired at once [s after the stamp].
  static double firedAfter(std::size_t echo) {
    return kTurn * static_cast<double>(echo % kColumns) / static_cast<double>(kColumns);
  }
  /// The topmost row looks at the sky; elsewhere single rays are lost.
  static bool isLost(std::size_t echo) { return echo < kColumns || echo % 11 == 3; }

  /// Where a ray ends, seen from where the sensor is at the cloud's stamp [m].
  Eigen::Vector3d target(std::size_t echo) const {
    const double angle = -2.0 * M_PI * firedAfter(echo) / kTurn;
    const double row = static_cast<double>(echo / kColumns), height = 2.0 - 3.0 * row / rows();
    return {12.0 * std::cos(angle), 12.0 * std::sin(angle), height};
  }

  /// A scan of a vehicle that drives at kSpeed along x.
  boost::shared_ptr<test::PointCloud2> scan() const {
    DriverCloud driver = test::driverNamed("ouster");
    driver.rows = rows();
    auto builder = test::builderOf(driver, static_cast<std::uint32_t>(echoes()), kStart);
    for (std::size_t i = 0; i < echoes(); ++i) {
      const Eigen::Vector3d seen = target(i) - Eigen::Vector3d(kSpeed * firedAfter(i), 0.0, 0.0);
      const double lost = GetParam().no_return;
      isLost(i) ? builder.at(i, lost, lost, lost) : builder.at(i, seen.x(), seen.y(), seen.z());
      builder.set(i, "t", 1e9 * firedAfter(i));
    }
    return builder.build();
  }
};

TEST_P(Ouster, PositionsAndTimesAreRead) {
  const auto cloud = scan();
  ASSERT_EQ(cloud->height, rows());
  ASSERT_EQ(cloud->row_step, kColumns * 48U);
  const CloudLayout layout = std::get<CloudLayout>(judgeLayout(*cloud));
  std::vector<Eigen::Vector3f> read;
  EchoTimes times;
  parseEchoes(*cloud, layout, read, times);
  ASSERT_EQ(read.size(), echoes());
  ASSERT_EQ(times.after_stamp.size(), echoes()) << times.problem;
  for (std::size_t i = 0; i < echoes(); ++i) {
    ASSERT_NEAR(static_cast<double>(times.after_stamp[i]), firedAfter(i), 1e-8) << i;
    ASSERT_EQ(read[i].allFinite(), !isLost(i)) << i;
    const Eigen::Vector3d seen = target(i) - Eigen::Vector3d(kSpeed * firedAfter(i), 0.0, 0.0);
    if (!isLost(i)) {
      ASSERT_LT((read[i].cast<double>() - seen).norm(), 1e-5) << i;
    }
  }
}

TEST_P(Ouster, ScansAreStraightenedAndStayOrganised) {
  PipelineRig rig;
  for (int i = -10; i < 30; ++i) {
    auto odometry = test::odometryAt(kStart + 0.01 * i);
    odometry.pose.pose.position.x = kSpeed * 0.01 * i;
    rig.pipeline.addOdometry(odometry);
  }
  rig.pipeline.addCloud(scan(), kStart);
  rig.run(kStart);
  ASSERT_EQ(rig.labeled.size(), 1U) << (rig.drops.empty() ? "" : rig.drops[0]);
  EXPECT_TRUE(rig.strange_times.empty()) << rig.strange_times[0];
  const test::Labeled& labeled = rig.labeled[0];
  EXPECT_EQ(labeled.published->height, rows());
  EXPECT_EQ(labeled.published->width, kColumns);
  ASSERT_EQ(labeled.echoes.size(), echoes());
  for (std::size_t i = 0; i < echoes(); ++i) {
    if (isLost(i)) {
      ASSERT_FALSE(labeled.echoes[i].allFinite()) << i;
      ASSERT_EQ(labeled.labels.dynamic[i], 0) << i;
    } else {
      ASSERT_LT((labeled.echoes[i].cast<double>() - target(i)).norm(), 1e-4) << i;
    }
  }
}

std::string nameOfCase(const testing::TestParamInfo<OusterCase>& info) {
  return std::to_string(info.param.rows) + (std::isnan(info.param.no_return) ? "RowsNaN" : "RowsZero");
}

INSTANTIATE_TEST_SUITE_P(Heights, Ouster,
                         testing::Values(OusterCase{32, 0.0}, OusterCase{64, 0.0}, OusterCase{128, 0.0},
                                         OusterCase{32, test::kNotANumber}, OusterCase{64, test::kNotANumber},
                                         OusterCase{128, test::kNotANumber}),
                         nameOfCase);

/// livox_ros_driver, the first one, as PointCloud2: 18 bytes and no time.
boost::shared_ptr<test::PointCloud2> oldLivoxScan(const std::vector<Eigen::Vector3f>& echoes, double stamp) {
  test::CloudBuilder builder;
  builder.stamp(stamp).xyz().fieldAt("intensity", PointField::FLOAT32, 12);
  builder.fieldAt("tag", PointField::UINT8, 16).fieldAt("line", PointField::UINT8, 17);
  builder.size(static_cast<std::uint32_t>(echoes.size()));
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    const Eigen::Vector3d echo = echoes[i].cast<double>();
    builder.at(i, echo.x(), echo.y(), echo.z());
  }
  return builder.build();
}

TEST(OldLivox, IsLabelledAsItIs) {
  PipelineRig rig;
  for (int i = -10; i < 30; ++i) rig.odometry(100.0 + 0.01 * i, kSpeed);
  auto cloud = oldLivoxScan(test::ring(), 100.0);
  ASSERT_EQ(cloud->point_step, 18U);
  const CloudLayout layout = std::get<CloudLayout>(judgeLayout(*cloud));
  EXPECT_FALSE(layout.time);
  rig.pipeline.addCloud(cloud, 100.0);
  rig.run(100.0);
  ASSERT_EQ(rig.labeled.size(), 1U) << (rig.drops.empty() ? "" : rig.drops[0]);
  EXPECT_TRUE(rig.strange_times.empty()) << rig.strange_times[0];
  EXPECT_EQ(rig.labeled[0].echoes, test::ring()) << "nothing says when each echo was measured";
  EXPECT_EQ(rig.labeled[0].published->point_step, 20U);
}

}  // namespace
}  // namespace donex
