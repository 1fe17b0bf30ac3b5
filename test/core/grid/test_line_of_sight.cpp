#include <algorithm>
#include <array>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "core/grid/line_of_sight.h"

namespace donex {
namespace {

std::vector<std::array<int, 3>> traverse(const LineOfSight& line) {
  std::vector<std::array<int, 3>> voxels;
  for (const Index3& v : line) voxels.push_back({v.x(), v.y(), v.z()});
  return voxels;
}

using Path = std::vector<std::array<int, 3>>;

TEST(LineOfSight, YieldsTheVoxelsBeforeTheEchosOwn) {
  EXPECT_EQ(traverse(LineOfSight({0.5F, 0.5F, 0.5F}, {3.5F, 0.5F, 0.5F})), (Path{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}));
  EXPECT_EQ(traverse(LineOfSight({0.5F, 0.5F, 0.5F}, {-1.5F, 0.5F, 0.5F})), (Path{{0, 0, 0}, {-1, 0, 0}}));
  EXPECT_EQ(traverse(LineOfSight({0.2F, 0.5F, 0.5F}, {1.5F, 1.4F, 0.5F})), (Path{{0, 0, 0}, {0, 1, 0}}));
}

TEST(LineOfSight, IsEmptyWithinOneVoxel) {
  EXPECT_TRUE(traverse(LineOfSight({0.5F, 0.5F, 0.5F}, {0.9F, 0.1F, 0.5F})).empty());
  EXPECT_TRUE(traverse(LineOfSight({0.5F, 0.5F, 0.5F}, {0.5F, 0.5F, 0.5F})).empty());
}

TEST(LineOfSight, EchoOnAFaceEndsInTheVoxelAboveIt) {
  EXPECT_EQ(traverse(LineOfSight({0.5F, 0.5F, 0.5F}, {2.0F, 0.5F, 0.5F})), (Path{{0, 0, 0}, {1, 0, 0}}));
  EXPECT_EQ(traverse(LineOfSight({2.5F, 0.5F, 0.5F}, {1.0F, 0.5F, 0.5F})), (Path{{2, 0, 0}}));
}

TEST(LineOfSight, ThroughAnEdgeTakesTheAxesInOrder) {
  EXPECT_EQ(traverse(LineOfSight({0.5F, 0.5F, 0.5F}, {1.5F, 1.5F, 1.5F})), (Path{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}));
}

class RandomLines : public ::testing::TestWithParam<unsigned> {};

TEST_P(RandomLines, StepsFaceToFaceToTheEchoAndAgreesWithCrosses) {
  std::mt19937 random(GetParam());
  std::uniform_real_distribution<float> coordinate(-9.0F, 9.0F);
  std::uniform_int_distribution<int> kind(0, 3);
  const auto point = [&] {
    Eigen::Vector3f p(coordinate(random), coordinate(random), coordinate(random));
    for (int axis = 0; axis < 3; ++axis) {
      if (kind(random) == 0) p[axis] = std::round(p[axis]);
      if (kind(random) == 0) p[axis] = std::round(2 * p[axis]) / 2;
    }
    return p;
  };
  for (int round = 0; round < 300; ++round) {
    const LineOfSight line(point(), point());
    const auto path = traverse(line);
    const std::set<std::array<int, 3>> on_line(path.begin(), path.end());
    EXPECT_EQ(on_line.size(), path.size()) << "a voxel is visited twice";
    Index3 last = line.originVoxel();
    for (std::size_t i = 1; i <= path.size(); ++i) {
      const Index3 next = i < path.size() ? Index3(path[i][0], path[i][1], path[i][2]) : line.echoVoxel();
      EXPECT_EQ((next - last).cwiseAbs().sum(), 1);
      last = next;
    }
    for (int x = -10; x <= 10; ++x) {
      for (int y = -10; y <= 10; ++y) {
        for (int z = -10; z <= 10; ++z) {
          ASSERT_EQ(line.crosses({x, y, z}), on_line.count({x, y, z}) != 0) << x << ' ' << y << ' ' << z;
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomLines, ::testing::Range(1U, 9U));

TEST(LineOfSight, SurvivesDenormalDirections) {
  const LineOfSight line({0.0F, 0.5F, 0.5F}, {-1e-42F, 0.5F, 3.5F});
  const auto path = traverse(line);
  EXPECT_EQ(path.size(), 4U);  // three faces in z, one in x
  EXPECT_EQ(line.echoVoxel(), Index3(-1, 0, 3));
}

}  // namespace
}  // namespace donex
