// A thousand small shifts: the residual is carried, contents stay within one voxel (algorithm: "Ego motion").
#include <gtest/gtest.h>

#include "core/grid/grid_2d.h"
#include "core/grid/grid_3d.h"
#include "core/sight/ray_index.h"
#include "donex/detector.h"

namespace donex {
namespace {

constexpr int kShifts = 1000;

Config grid(Method method, Compensation compensation) {
  Config config = paperConfig(method);
  config.compensation = compensation;
  config.voxel_size = 0.5;
  config.region = {-40, 40, -40, 40, -6, 6};
  return config;
}

/// 3 m/s at 10 Hz, far less than a voxel of 0.5 m a scan, in a bend, with roll and pitch.
Eigen::Isometry3d poseAfter(int shifts) {
  const double turn = 0.002 * shifts;
  return Eigen::Translation3d(5.0 * std::sin(turn), 5.0 * (1.0 - std::cos(turn)), 0.05 * std::sin(0.05 * shifts)) *
         Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(0.02 * std::sin(0.1 * shifts), Eigen::Vector3d::UnitY());
}

/// One scan of echoes far from each other, so that no two contents ever share a voxel.
Scan landmarks() {
  Scan scan;
  scan.stamp = 1.0;
  for (int x = -20; x <= 20; x += 5) {
    for (int y = -20; y <= 20; y += 5) {
      scan.echoes.emplace_back(static_cast<float>(x) + 0.3F, static_cast<float>(y) + 0.2F, 0.3F);
    }
  }
  return scan;
}

/// Shows the memory a scan, and then nothing while it moves on.
template <class Memory>
void takeAndMoveOn(Memory& memory, const Scan& scan) {
  EchoLabels labels;
  memory.beginTurn(Eigen::Isometry3d::Identity());
  memory.take(scan, labels);
  for (int k = 1; k <= kShifts; ++k) {
    memory.beginTurn(poseAfter(k));
    memory.take(Scan(), labels);
  }
}

class VoxelShift : public ::testing::TestWithParam<Compensation> {};

TEST_P(VoxelShift, KeepsContentsWithinOneVoxelIn3d) {
  Grid3d<RayIndex> memory(grid(Method::kDonex3d, GetParam()));
  const Scan scan = landmarks();
  takeAndMoveOn(memory, scan);
  const auto voxels = memory.remembered();
  ASSERT_EQ(voxels.size(), scan.echoes.size());
  const double voxel = memory.window().voxelSize();
  for (const Eigen::Vector3f& echo : scan.echoes) {
    // What the composed transform says, beside the nearest remembered voxel's centre.
    double nearest = std::numeric_limits<double>::infinity();
    for (const Index3& v : voxels) {
      const Eigen::Vector3d center = memory.window().odomFromGrid() * memory.window().indexToCenter(v);
      nearest = std::min(nearest, (center - echo.cast<double>()).cwiseAbs().maxCoeff());
    }
    EXPECT_LE(nearest, voxel) << echo.transpose();
  }
}

TEST_P(VoxelShift, KeepsRangesWithinOneVoxelIn2d) {
  Grid2d memory(grid(Method::kDonex2d, GetParam()));
  const Scan scan = landmarks();
  takeAndMoveOn(memory, scan);
  const GridWindow& window = memory.window();
  int ranges = 0;
  for (int x = 0; x < window.extent().x(); ++x) {
    for (int y = 0; y < window.extent().y(); ++y) {
      const HeightRange range = memory.rangeAt(x, y);
      if (range.empty()) continue;
      ++ranges;
      const Eigen::Vector3d center = window.odomFromGrid() * window.indexToCenter({x, y, 0});
      double nearest = std::numeric_limits<double>::infinity();
      for (const Eigen::Vector3f& echo : scan.echoes) {
        nearest = std::min(nearest, (center - echo.cast<double>()).head<2>().cwiseAbs().maxCoeff());
      }
      EXPECT_LE(nearest, window.voxelSize());
    }
  }
  EXPECT_EQ(ranges, static_cast<int>(scan.echoes.size()));
}

TEST_P(VoxelShift, ForgetsWhatLeavesTheWindow) {
  Grid3d<RayIndex> memory(grid(Method::kDonex3d, GetParam()));
  EchoLabels labels;
  memory.beginTurn(Eigen::Isometry3d::Identity());
  memory.take(landmarks(), labels);
  memory.beginTurn(Eigen::Isometry3d(Eigen::Translation3d(200, 0, 0)));
  EXPECT_TRUE(memory.remembered().empty());
  memory.take(Scan(), labels);
  memory.beginTurn(Eigen::Isometry3d::Identity());
  EXPECT_TRUE(memory.remembered().empty()) << "what was forgotten does not come back";
}

INSTANTIATE_TEST_SUITE_P(Both, VoxelShift, ::testing::Values(Compensation::kScroll, Compensation::kResample));

TEST(VoxelShift, AScrollingGridSeesAStandingPoleAsStaticFromAMovingSensor) {
  const auto detector = makeDetector(grid(Method::kDonex3d, Compensation::kScroll));
  for (int k = 0; k <= 50; ++k) {
    Scan scan;
    scan.stamp = 1.0 + 0.1 * k;
    scan.odom_from_base = Eigen::Translation3d(0.1 * k, 0, 0);
    scan.echoes = {(scan.odom_from_base.inverse() * Eigen::Vector3d(20.25, 3.25, 0.25)).cast<float>()};
    EchoLabels labels;
    detector->process(scan, labels);
    EXPECT_EQ(labels.dynamic[0], 0) << "scan " << k;
    EXPECT_EQ(labels.observed[0], k > 0 ? 1 : 0);
  }
}

}  // namespace
}  // namespace donex
