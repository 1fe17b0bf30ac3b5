// The mesh of a scan, and the evidence that is combined from several.
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "core/methods/motion_belief.h"
#include "core/methods/scan_mesh.h"

namespace donex {
namespace {

constexpr double kDegree = M_PI / 180.0;

Eigen::Vector3f directionOf(double azimuth, double elevation) {
  return Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                         std::sin(elevation))
      .cast<float>();
}

/// A sensor with rings every degree and shots every 0.2 degrees looks at `rangeOf(direction)`.
template <class RangeOf>
std::vector<Eigen::Vector3f> spin(RangeOf&& rangeOf) {
  std::vector<Eigen::Vector3f> echoes;
  for (int ring = -20; ring <= 5; ++ring) {
    for (int shot = 0; shot < 1800; ++shot) {
      const Eigen::Vector3f direction = directionOf(shot * 0.2 * kDegree - M_PI + 1e-4, ring * kDegree);
      echoes.push_back(direction * rangeOf(direction));
    }
  }
  return echoes;
}

TEST(ScanMesh, MeetsAPlaneWhereItIs) {
  // The plane x + 0.3 y = 12, seen where it faces the sensor; nothing elsewhere.
  const auto rangeOf = [](const Eigen::Vector3f& d) {
    const float along = d.x() + 0.3F * d.y();
    return along > 0.3F ? 12.0F / along : std::numeric_limits<float>::quiet_NaN();
  };
  ScanMesh mesh(1.5 * kDegree);
  mesh.build(spin(rangeOf));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> azimuth(-40.0, 60.0), elevation(-19.0, 4.0);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3f direction = directionOf(azimuth(random) * kDegree, elevation(random) * kDegree);
    const auto surface = mesh.at(direction);
    ASSERT_TRUE(surface);
    EXPECT_FALSE(surface->is_edge);
    EXPECT_NEAR(surface->range, rangeOf(direction), 1e-3F * rangeOf(direction));
    EXPECT_NEAR(surface->cosine, 12.0F / rangeOf(direction) / std::sqrt(1.09F), 1e-2F);
  }
}

TEST(ScanMesh, AStepInDepthIsAnEdgeWithBothRanges) {
  ScanMesh mesh(1.5 * kDegree);
  mesh.build(spin([](const Eigen::Vector3f& d) { return d.y() > 0.0F ? 5.0F : 20.0F; }));
  int edges = 0;
  for (double azimuth = -0.5; azimuth < 0.5; azimuth += 0.013) {
    const auto surface = mesh.at(directionOf(azimuth * kDegree, 0.3 * kDegree));
    ASSERT_TRUE(surface);
    if (!surface->is_edge) continue;
    ++edges;
    EXPECT_NEAR(surface->range, 5.0F, 1e-3F);
    EXPECT_NEAR(surface->far_range, 20.0F, 1e-3F);
    EXPECT_LT(std::abs(azimuth), 0.41);
  }
  EXPECT_GT(edges, 5);
}

TEST(ScanMesh, WhereNothingSurroundsADirectionThereIsNoSurface) {
  ScanMesh mesh(1.5 * kDegree);
  EXPECT_FALSE(mesh.at({1, 0, 0}));
  mesh.build(spin([](const Eigen::Vector3f&) { return 10.0F; }));
  EXPECT_FALSE(mesh.at(directionOf(0.0, 7.0 * kDegree)));    // above the highest ring
  EXPECT_FALSE(mesh.at(directionOf(0.0, -22.0 * kDegree)));  // below the lowest
  EXPECT_TRUE(mesh.at(directionOf(M_PI - 1e-5, 0.0)));       // across the seam
  ScanMesh strict(0.5 * kDegree);                            // rings are farther apart than that
  strict.build(spin([](const Eigen::Vector3f&) { return 10.0F; }));
  EXPECT_FALSE(strict.at(directionOf(0.0, 0.5 * kDegree)));
}

TEST(MotionBelief, DempstersRuleByHand) {
  // Conflict 0.6 * 0.3 + 0.1 * 0.5 = 0.23.
  const MotionBelief both = MotionBelief{0.6, 0.1}.combinedWith({0.5, 0.3});
  EXPECT_NEAR(both.dynamic, (0.6 * 0.5 + 0.6 * 0.2 + 0.3 * 0.5) / 0.77, 1e-12);
  EXPECT_NEAR(both.fixed, (0.1 * 0.3 + 0.1 * 0.2 + 0.3 * 0.3) / 0.77, 1e-12);
  EXPECT_NEAR(both.unknown(), 0.3 * 0.2 / 0.77, 1e-12);
}

TEST(MotionBelief, IgnoranceChangesNothingAndContradictionLeavesNothing) {
  const MotionBelief some{0.7, 0.2};
  EXPECT_DOUBLE_EQ(some.combinedWith({}).dynamic, 0.7);
  EXPECT_DOUBLE_EQ(MotionBelief().combinedWith(some).fixed, 0.2);
  EXPECT_DOUBLE_EQ((MotionBelief{1.0, 0.0}.combinedWith({0.0, 1.0}).unknown()), 1.0);
}

}  // namespace
}  // namespace donex
