#include <stdexcept>

#include <gtest/gtest.h>

#include "evaluation/drift.h"

namespace donex {
namespace {

using Poses = std::vector<Eigen::Isometry3d>;

/// A drive along x, a scan every `step` [m], that turns by `turn` [rad] from scan to scan.
Poses drive(int scans, double step, double turn) {
  Poses poses(1, Eigen::Isometry3d::Identity());
  const Eigen::Isometry3d motion = Eigen::Translation3d(step, 0, 0) * Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ());
  while (static_cast<int>(poses.size()) < scans) poses.push_back(poses.back() * motion);
  return poses;
}

TEST(Drift, IsNoneOfEqualMotionInAnotherFrame) {
  const Poses reference = drive(40, 1.0, 0.05);
  Poses moved = reference;
  for (auto& pose : moved)
    pose = Eigen::Translation3d(5, 6, 7) * Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitX()) * pose;
  const Drift drift = driftOver(moved, reference, 10.0);
  EXPECT_EQ(drift.pieces, 30U);
  EXPECT_LT(drift.translation, 1e-12);
  EXPECT_LT(drift.rotation, 1e-7);
}

TEST(Drift, TellsAScaleAndATurn) {
  EXPECT_NEAR(driftOver(drive(40, 1.02, 0.0), drive(40, 1.0, 0.0), 10.0).translation, 0.02, 1e-9);
  EXPECT_NEAR(driftOver(drive(40, 1.0, 0.003), drive(40, 1.0, 0.0), 10.0).rotation, 0.03, 1e-9);
}

TEST(Drift, OfAShortDriveIsNotKnown) {
  EXPECT_EQ(driftOver(drive(9, 1.0, 0.0), drive(9, 1.0, 0.0), 10.0).pieces, 0U);
  EXPECT_EQ(driftOver({}, {}, 10.0).pieces, 0U);
  EXPECT_THROW(driftOver(drive(3, 1.0, 0.0), drive(4, 1.0, 0.0), 10.0), std::invalid_argument);
}

}  // namespace
}  // namespace donex
