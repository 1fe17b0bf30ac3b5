#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/motion/gaussian_map.h"

namespace donex {
namespace {

/// A square of ground, a point every 5 cm, in the voxel around `center`.
void addSquare(GaussianMap& map, const Eigen::Vector3d& center) {
  for (double x = -0.2; x < 0.21; x += 0.05) {
    for (double y = -0.2; y < 0.21; y += 0.05) map.add(center + Eigen::Vector3d(x, y, 0.0));
  }
}

TEST(GaussianMap, KnowsAPlaneByItsNormal) {
  GaussianMap map;
  const Eigen::Vector3d center(10.25, -3.75, 0.25);
  addSquare(map, center);
  const SurfaceMatch match = map.surfaceAt(center + Eigen::Vector3d(0.1, 0.1, 0.2));
  ASSERT_NE(match.surface, nullptr);
  EXPECT_FALSE(match.is_pole);
  EXPECT_NEAR(std::abs(match.surface->normal.z()), 1.0, 1e-6);
  EXPECT_LT((match.mean - center).norm(), 1e-6);
}

TEST(GaussianMap, TakesAnUprightLineForAPoleAndNoRingOfGround) {
  GaussianMap map;
  for (double t = -0.24; t < 0.25; t += 0.02) {
    map.add(Eigen::Vector3d(0.25, 0.25, 0.25 + t));
    map.add(Eigen::Vector3d(8.25, 0.25 + t, 0.25));
  }
  const SurfaceMatch pole = map.surfaceAt(Eigen::Vector3d(0.3, 0.2, 0.25));
  ASSERT_NE(pole.surface, nullptr);
  EXPECT_TRUE(pole.is_pole);
  EXPECT_EQ(map.surfaceAt(Eigen::Vector3d(8.25, 0.25, 0.25)).surface, nullptr);
}

TEST(GaussianMap, KnowsNothingOfScatteredEchoesAndOfEmptySpace) {
  GaussianMap map;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(0.0, 2.0);
  for (int i = 0; i < 5000; ++i) map.add(Eigen::Vector3d(number(random), number(random), number(random)));
  EXPECT_EQ(map.surfaceAt(Eigen::Vector3d(1.1, 1.1, 1.1)).surface, nullptr);
  EXPECT_EQ(map.surfaceAt(Eigen::Vector3d(50.0, 1.1, 1.1)).surface, nullptr);
}

TEST(GaussianMap, ForgetsWhatIsOutOfReachAndNothingElse) {
  GaussianMap map;
  std::vector<Eigen::Vector3d> centers;
  for (int i = -60; i <= 60; ++i) {
    for (int j = -60; j <= 60; ++j) centers.emplace_back(2.0 * i + 0.25, 2.0 * j + 0.25, 0.25);
  }
  for (const Eigen::Vector3d& center : centers) addSquare(map, center);
  const Eigen::Vector3d vehicle(30.0, 20.0, 0.0);
  map.moveTo(vehicle);
  const double reach = GaussianMap::Options().reach;
  int kept = 0, forgotten = 0;
  for (const Eigen::Vector3d& center : centers) {
    const double distance = (center - vehicle).norm();
    if (std::abs(distance - reach) < 3.0) continue;  // a coarse voxel reaches across
    const bool is_known = map.surfaceAt(center).surface != nullptr;
    EXPECT_EQ(is_known, distance < reach) << center.transpose();
    ++(is_known ? kept : forgotten);
  }
  EXPECT_GT(kept, 1000);
  EXPECT_GT(forgotten, 1000);
}

TEST(GaussianMap, NeverGrows) {
  GaussianMap map;
  const std::size_t before = map.memoryBytes();
  std::mt19937 random(4);
  std::uniform_real_distribution<double> number(-90.0, 90.0);
  for (int i = 0; i < 400000; ++i) {
    map.add(Eigen::Vector3d(number(random), number(random), number(random)));
    if (i % 20000 == 0) map.moveTo(Eigen::Vector3d::Zero());
  }
  EXPECT_EQ(map.memoryBytes(), before);
  const Eigen::Vector3d center(0.25, 0.25, 0.25);
  map.moveTo(Eigen::Vector3d::Zero());
  addSquare(map, center);
  EXPECT_NE(map.surfaceAt(center).surface, nullptr) << "there is room for what is near";
}

}  // namespace
}  // namespace donex
