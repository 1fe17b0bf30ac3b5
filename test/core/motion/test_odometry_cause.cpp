// Causes told from two tracks alone: one true, one with a fault.
#include <cmath>
#include <deque>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "core/motion/odometry_calibration.h"
#include "core/motion/odometry_cause.h"
#include "core/motion/odometry_correction.h"
#include "core/pi.h"
#include "donex/motion/rigid_motion.h"

namespace donex {
namespace {

constexpr int kScans = 120;
constexpr double kPeriod = 0.1;  // [s]

/// An S at 6 m/s that begins at a heading of its own.
Eigen::Isometry3d truthAt(double stamp) {
  constexpr double kStep = 0.01;  // [s]
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.rotate(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()));
  for (double time = 0.0; time < stamp - 1e-9; time += kStep) {
    pose = pose * integrateTwist({{6.0, 0.0, 0.0}, {0.0, 0.0, 0.5 * std::sin(0.9 * time)}}, kStep);
  }
  return pose;
}

using Fault = std::function<Eigen::Isometry3d(const Poses& truth, int scan)>;

std::deque<ComparedScan> tracksWith(const Fault& fault) {
  static const Poses kTruth = [] {
    Poses truth;
    for (int i = 0; i < kScans; ++i) truth.push_back(truthAt(kPeriod * i));
    return truth;
  }();
  std::deque<ComparedScan> scans;
  for (int i = 0; i < kScans; ++i) {
    const auto k = static_cast<std::size_t>(i);
    scans.push_back({kPeriod * i, fault(kTruth, i), kTruth.front().inverse() * kTruth[k]});
  }
  return scans;
}

const Eigen::Isometry3d& at(const Poses& truth, int scan) { return truth[static_cast<std::size_t>(scan)]; }

CauseFinding causeOf(const Fault& fault, bool is_twist = false) { return findCause(tracksWith(fault), {}, is_twist); }

TEST(OdometryCause, OfASoundOdometryIsNone) {
  const CauseFinding finding = causeOf([](const Poses& truth, int i) { return at(truth, i); });
  EXPECT_EQ(finding.cause, OdometryCause::kUnknown);
  EXPECT_LT(finding.before, 1e-6);
}

TEST(OdometryCause, MountingThatIsBelievedTooFarToTheLeft) {
  const double yaw = 2.0 * kPi / 180.0;
  const CauseFinding finding = causeOf(
      [&](const Poses& truth, int i) { return at(truth, i) * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()); });
  EXPECT_EQ(finding.cause, OdometryCause::kMountingYaw);
  EXPECT_NEAR(finding.figure, -yaw, 1e-3);
  EXPECT_EQ(describe(finding), "the yaw of the mounting, believed 2.0 degrees too far to the left");
}

TEST(OdometryCause, Scale) {
  const CauseFinding finding = causeOf([](const Poses& truth, int i) {
    Eigen::Isometry3d pose = at(truth, i);
    pose.translation() *= 0.93;
    return pose;
  });
  EXPECT_EQ(finding.cause, OdometryCause::kScale);
  EXPECT_NEAR(finding.figure, 0.93, 1e-3);
}

TEST(OdometryCause, StampsThatAreLateShowWhereTheVehicleTurns) {
  const CauseFinding finding = causeOf([](const Poses&, int i) { return truthAt(std::max(0.0, kPeriod * i - 0.2)); });
  EXPECT_EQ(finding.cause, OdometryCause::kTimeOffset);
  EXPECT_NEAR(finding.figure, 0.2, 0.011);
}

TEST(OdometryCause, AxesByTheirNames) {
  for (const AxisFault& fault : axisFaults()) {
    // Each of these undoes itself, but for those that swap and turn.
    const CauseFinding finding =
        causeOf([&](const Poses& truth, int i) { return withAxes({at(truth, i)}, fault).front(); });
    EXPECT_EQ(finding.cause, OdometryCause::kAxes) << fault.name;
    EXPECT_LT(finding.remaining, 1e-6) << fault.name << " is undone by " << finding.detail;
  }
}

TEST(OdometryCause, FrozenForAWhile) {
  const CauseFinding finding = causeOf([](const Poses& truth, int i) { return at(truth, i >= 40 && i < 60 ? 40 : i); });
  EXPECT_EQ(finding.cause, OdometryCause::kFrozen);
  EXPECT_DOUBLE_EQ(finding.figure, 19.0);
}

TEST(OdometryCause, AJump) {
  const CauseFinding finding = causeOf([](const Poses& truth, int i) {
    Eigen::Isometry3d pose = at(truth, i);
    if (i >= 50) pose.translation().y() += 0.7;
    return pose;
  });
  EXPECT_EQ(finding.cause, OdometryCause::kJump);
  EXPECT_NEAR(finding.figure, 0.7, 1e-6);
}

TEST(OdometryCause, VelocitiesInTheAxesOfTheFixedFrame) {
  const CauseFinding finding = causeOf(
      [](const Poses& truth, int i) {
        // Integrated as if they were the vehicle's: the heading counts twice.
        Eigen::Isometry3d pose = truth.front();
        for (int k = 1; k <= i; ++k) {
          const Eigen::Vector3d step = at(truth, k).translation() - at(truth, k - 1).translation();
          pose.translation() += at(truth, k - 1).linear() * step;
        }
        pose.linear() = at(truth, i).linear();
        return pose;
      },
      true);
  EXPECT_EQ(finding.cause, OdometryCause::kWorldTwist);
  EXPECT_LT(finding.remaining, 0.05);
}

TEST(OdometryCause, IsNotGuessed) {
  const CauseFinding finding = causeOf([](const Poses& truth, int i) {
    Eigen::Isometry3d pose = at(truth, i);
    pose.translation() += Eigen::Vector3d(1.5 * std::sin(1.7 * i), 1.5 * std::sin(2.3 * i), 0.0);
    return pose;
  });
  EXPECT_EQ(finding.cause, OdometryCause::kUnknown);
  EXPECT_GT(finding.before, 1.0);
}

TEST(OdometryCause, OfFewScansNeedsNoWindow) {
  for (std::size_t scans = 0; scans < 3; ++scans) {
    auto tracks = tracksWith([](const Poses& truth, int i) { return at(truth, i); });
    tracks.resize(scans);
    EXPECT_EQ(findCause(tracks, {}, true).cause, OdometryCause::kUnknown);
  }
}

TEST(OdometryCalibration, TellsMountingScaleAndStampsAtOnce) {
  const double yaw = 1.5 * kPi / 180.0;
  const auto scans = tracksWith([&](const Poses&, int i) {
    Eigen::Isometry3d pose =
        truthAt(std::max(0.0, kPeriod * i - 0.1)) * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
    pose.translation() *= 1.04;
    return pose;
  });
  const OdometryCalibration found = calibrate(scans, {});
  ASSERT_TRUE(found.yaw.is_known && found.scale.is_known && found.time_offset.is_known);
  EXPECT_NEAR(found.scale.value, 1.04, 0.003);
  EXPECT_NEAR(found.time_offset.value, 0.1, 0.021);
  EXPECT_NEAR(found.yaw.value, -yaw, 0.01);
  EXPECT_LT(found.scale.deviation, 0.02);
}

TEST(OdometryCalibration, OfASoundOdometryIsNothingToMend) {
  const OdometryCalibration found = calibrate(tracksWith([](const Poses& truth, int i) { return at(truth, i); }), {});
  EXPECT_NEAR(found.yaw.value, 0.0, 1e-6);
  EXPECT_NEAR(found.scale.value, 1.0, 1e-6);
  EXPECT_NEAR(found.time_offset.value, 0.0, 1e-6);
  EXPECT_TRUE(found.time_offset.is_known);
  const auto lines = describe(found, Eigen::Isometry3d::Identity(), "base_link", "lidar");
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_NE(lines[1].find("static_transform_publisher 0.000 0.000 0.000 0.00000"), std::string::npos) << lines[1];
}

TEST(OdometryCalibration, OfADriveThatTellsNothingSaysSo) {
  const auto standing = tracksWith([](const Poses&, int) { return Eigen::Isometry3d::Identity(); });
  std::deque<ComparedScan> scans = standing;
  for (ComparedScan& scan : scans) scan.found = Eigen::Isometry3d::Identity();
  const OdometryCalibration found = calibrate(scans, {});
  EXPECT_FALSE(found.yaw.is_known || found.scale.is_known || found.time_offset.is_known);
  EXPECT_EQ(describe(found, Eigen::Isometry3d::Identity(), "base_link", "lidar").size(), 3U);
  EXPECT_FALSE(calibrate({}, {}).yaw.is_known);
}

}  // namespace
}  // namespace donex
