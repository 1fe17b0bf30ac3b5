#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/motion/motion_samples.h"
#include "core/motion/odometry_check.h"
#include "core/motion/surfaces.h"

namespace donex {
namespace {

using testing::corridor;
using testing::courtyard;
using testing::seenFrom;
using testing::SteadyDrive;

SteadyDrive bendingDrive() { return {{{4.0, 0.0, 0.0}, {0.0, 0.0, 0.3}}}; }

Eigen::Isometry3d mounting() {
  Eigen::Isometry3d base_from_sensor = Eigen::Isometry3d::Identity();
  base_from_sensor.translation() = Eigen::Vector3d(0.8, 0.0, 1.7);
  base_from_sensor.rotate(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()));
  return base_from_sensor;
}

/// Drives through the courtyard; `told` is what the odometry makes of the true pose of the vehicle.
template <class Told>
void drive(OdometryCheck& check, int scans, const Told& told) {
  static const auto kWorld = courtyard();
  for (int i = 0; i < scans; ++i) {
    const Eigen::Isometry3d truth = bendingDrive().poseAt(0.1 * i);
    const auto echoes = seenFrom(truth * mounting(), kWorld);
    check.check({0.1 * i, echoes, mounting(), told(truth, i)});
  }
}

TEST(OdometryCheck, AgreesWithTheTruth) {
  OdometryCheck check;
  drive(check, 25, [](const Eigen::Isometry3d& truth, int) { return truth; });
  EXPECT_EQ(check.finding().agreement, Agreement::kAgrees);
  EXPECT_GT(check.finding().windows, 0U);
  EXPECT_EQ(check.finding().harmful, 0U);
  EXPECT_EQ(check.finding().jumps, 0U);
  EXPECT_LT(check.finding().largest.harm(), 0.05);
  EXPECT_NE(summaryOf(check.finding()).find("agrees with the scans within 0.00 m"), std::string::npos)
      << summaryOf(check.finding());
}

TEST(OdometryCheck, DoesNotLookAtWhatItChecks) {
  OdometryCheck check;
  drive(check, 25, [](const Eigen::Isometry3d& truth, int i) {
    Eigen::Isometry3d wild = truth;
    wild.translation() += 30.0 * Eigen::Vector3d(std::sin(i), std::cos(i), 0.0);
    return wild;
  });
  EXPECT_EQ(check.finding().agreement, Agreement::kDisagrees);
  EXPECT_NEAR(check.finding().largest.way, 8.2, 0.21) << "8 m, or one step more";
}

TEST(OdometryCheck, NamesTheScale) {
  OdometryCheck check;
  drive(check, 25, [](Eigen::Isometry3d truth, int) {
    truth.translation() *= 1.1;
    return truth;
  });
  EXPECT_EQ(check.finding().agreement, Agreement::kDisagrees);
  EXPECT_EQ(check.finding().alarm_scan, 20U) << "as soon as there is one window";
  EXPECT_EQ(check.finding().cause.cause, OdometryCause::kScale);
  EXPECT_NE(summaryOf(check.finding()).find("its scale, 1.100"), std::string::npos) << summaryOf(check.finding());
}

TEST(OdometryCheck, TellsAJumpOnce) {
  OdometryCheck check;
  std::vector<double> jumps;
  static const auto kWorld = courtyard();
  for (int i = 0; i < 14; ++i) {
    const Eigen::Isometry3d truth = bendingDrive().poseAt(0.1 * i);
    Eigen::Isometry3d told = truth;
    if (i >= 10) told.translation().y() += 0.5;
    jumps.push_back(check.check({0.1 * i, seenFrom(truth, kWorld), Eigen::Isometry3d::Identity(), told}).jump);
  }
  EXPECT_EQ(check.finding().jumps, 1U);
  EXPECT_NEAR(jumps[10], 0.5, 0.01);
}

TEST(OdometryCheck, BeginsAnewAfterAGap) {
  OdometryCheck check;
  static const auto kWorld = courtyard();
  for (int i = 0; i < 40; ++i) {
    const double stamp = 0.1 * i + 0.9 * (i / 8);  // as where a busy machine drops clouds
    const Eigen::Isometry3d truth = bendingDrive().poseAt(stamp);
    check.check({stamp, seenFrom(truth, kWorld), Eigen::Isometry3d::Identity(), truth});
    EXPECT_NE(check.finding().agreement, Agreement::kDisagrees) << i;
  }
  EXPECT_EQ(check.finding().windows, 0U) << "none is that short";
  EXPECT_EQ(check.finding().jumps, 0U);
}

TEST(OdometryCheck, CannotTellAlongACorridor) {
  OdometryCheck check;
  const auto echoes = seenFrom(Eigen::Isometry3d::Identity(), corridor(-39.9, 39.9));
  for (int i = 0; i < 6; ++i) {
    Eigen::Isometry3d told = Eigen::Isometry3d::Identity();
    told.translation().x() = i;
    check.check({0.1 * i, echoes, Eigen::Isometry3d::Identity(), told});
  }
  EXPECT_EQ(check.finding().agreement, Agreement::kCannotTell);
  EXPECT_GT(check.finding().untold, 0U);
  EXPECT_EQ(check.finding().windows, 0U);
  EXPECT_EQ(summaryOf(check.finding()).find("agrees"), std::string::npos);
}

TEST(OdometryCheck, LabelsThatFloodTheScanAreNoHelp) {
  OdometryCheck check;
  static const auto kWorld = courtyard();
  for (int i = 0; i < 25; ++i) {
    const Eigen::Isometry3d truth = bendingDrive().poseAt(0.1 * i);
    const auto echoes = seenFrom(truth, kWorld);
    check.check({0.1 * i, echoes, Eigen::Isometry3d::Identity(), truth});
    check.learn(std::vector<std::uint8_t>(echoes.size(), 1));
  }
  EXPECT_EQ(check.finding().agreement, Agreement::kAgrees);
}

}  // namespace
}  // namespace donex
