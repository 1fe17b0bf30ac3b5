// The methods of the comparison on scenes whose labels can be told by hand, and what holds for all of them.
#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "core/methods/region_planes.h"
#include "donex/memory_bound.h"
#include "donex/whole_drive.h"
#include "support/random_scans.h"

namespace donex {
namespace {

constexpr double kDegree = M_PI / 180.0;

Config configOf(Method method) {
  Config config;
  config.method = method;
  return config;
}

/// A sensor 1.7 m above flat ground, in a ring of walls 15 m away, and a post 0.4 m wide at (x, y), or none at all.
Scan lookAround(double stamp, double post_x, double post_y) {
  Scan scan;
  scan.stamp = stamp;
  const Eigen::Vector2d post(post_x, post_y);
  for (int ring = -60; ring <= 5; ++ring) {
    for (int shot = 0; shot < 1800; ++shot) {
      const double azimuth = shot * 0.2 * kDegree, elevation = ring * 0.4 * kDegree;
      const Eigen::Vector2d along(std::cos(azimuth), std::sin(azimuth));
      double range = 15.0 / std::cos(elevation);
      if (ring < 0) range = std::min(range, 1.7 / std::sin(-elevation));
      const double off = std::abs(along.x() * post.y() - along.y() * post.x());
      const bool meets_post = off < 0.2 && along.dot(post) > 0.0 && post.norm() < range * std::cos(elevation);
      if (meets_post) range = post.norm() / std::cos(elevation);
      scan.echoes.push_back(
          (Eigen::Vector3d(along.x(), along.y(), std::tan(elevation)) * range * std::cos(elevation)).cast<float>());
    }
  }
  return scan;
}

bool isPost(const Eigen::Vector3f& echo, double x, double y) {
  return std::abs(echo.head<2>().norm() - std::hypot(x, y)) < 0.01F &&
         (echo.head<2>().cast<double>() - Eigen::Vector2d(x, y)).norm() < 0.3 && echo.z() > -1.3F;
}

struct Share {
  double post = 0.0, rest = 0.0;
};

/// Shares of dynamic echoes on the post and elsewhere in the last of the scans.
Share judge(Method method, const std::vector<Eigen::Vector2d>& posts) {
  const auto detector = makeDetector(configOf(method));
  EchoLabels labels;
  Scan scan;
  for (std::size_t k = 0; k < posts.size(); ++k) {
    scan = lookAround(1.0 + 0.1 * static_cast<double>(k), posts[k].x(), posts[k].y());
    detector->process(scan, labels);
  }
  Share share;
  double on_post = 0.0, elsewhere = 0.0;
  for (std::size_t i = 0; i < scan.echoes.size(); ++i) {
    const bool is_post = isPost(scan.echoes[i], posts.back().x(), posts.back().y());
    (is_post ? on_post : elsewhere) += 1.0;
    (is_post ? share.post : share.rest) += labels.dynamic[i];
  }
  EXPECT_GT(on_post, 20.0);
  return {share.post / on_post, share.rest / elsewhere};
}

class LiveMethods : public ::testing::TestWithParam<Method> {};

TEST_P(LiveMethods, FindWhatComesIntoSpaceThatWasFree) {
  std::vector<Eigen::Vector2d> posts(12, {100.0, 0.0});  // behind the walls: none
  posts.push_back({8.0, 1.0});
  const Share share = judge(GetParam(), posts);
  EXPECT_GT(share.post, 0.7);  // the voxel grid misses voxels between the rings
  EXPECT_LT(share.rest, 0.01);
}

TEST_P(LiveMethods, FindNothingWhereNothingMoves) {
  const Share share = judge(GetParam(), std::vector<Eigen::Vector2d>(13, {8.0, 1.0}));
  EXPECT_LT(share.post, 0.02);
  EXPECT_LT(share.rest, 0.001);
}

TEST_P(LiveMethods, SayNothingOfTheFirstScan) {
  const Share share = judge(GetParam(), {{8.0, 1.0}});
  EXPECT_EQ(share.post, 0.0);
  EXPECT_EQ(share.rest, 0.0);
}

TEST_P(LiveMethods, HoldTheInterface) {
  const auto detector = makeDetector(configOf(GetParam()));
  testing::RandomScans source(5, 0.2, 30.0F);
  EchoLabels labels, again;
  std::vector<EchoLabels> first;
  std::vector<Scan> scans;
  for (int k = 0; k < 8; ++k) {
    scans.push_back(source.next(2000));
    detector->process(scans.back(), labels);
    ASSERT_EQ(labels.dynamic.size(), scans.back().echoes.size());
    for (std::size_t i = 0; i < labels.dynamic.size(); ++i) {
      EXPECT_LE(labels.dynamic[i], 1);
      const bool is_echo = scans.back().echoes[i].allFinite();
      EXPECT_LE(labels.dynamic[i] + labels.observed[i], is_echo ? 2 : 0);
    }
    first.push_back(labels);
  }
  EXPECT_THROW(detector->process(scans.front(), labels), std::invalid_argument);
  EXPECT_GT(detector->memoryBytes(), 0U);
  detector->reset();
  for (std::size_t k = 0; k < scans.size(); ++k) {
    detector->process(scans[k], again);
    EXPECT_EQ(again.dynamic, first[k].dynamic) << "not as a new detector";
  }
}

std::vector<Method> liveMethods() {
  std::vector<Method> methods;
  for (const Method method : allMethods()) {
    const MethodInfo& info = infoOf(method);
    if (info.kind != MethodKind::kDonex && !info.needs_whole_drive) methods.push_back(method);
  }
  return methods;
}

INSTANTIATE_TEST_SUITE_P(Comparison, LiveMethods, ::testing::ValuesIn(liveMethods()),
                         [](const auto& method) { return nameOf(method.param); });

TEST(MethodList, EveryMethodIsBuiltByItsName) {
  std::set<std::string> names;
  for (const Method method : allMethods()) {
    const MethodInfo& info = infoOf(method);
    EXPECT_EQ(info.method, method);
    EXPECT_EQ(info.name, nameOf(method));
    EXPECT_TRUE(names.insert(info.name).second) << info.name << " stands twice";
    EXPECT_FALSE(std::string(info.what).empty() || std::string(info.source).empty()) << info.name;
    const Config config = configOf(method);
    EXPECT_GE(memoryBound(config, kUsualScan), 0.0);
    if (info.needs_whole_drive) {
      EXPECT_NE(makeWholeDriveDetector(config), nullptr);
      EXPECT_THROW(makeDetector(config), std::invalid_argument) << info.name;
    } else {
      EXPECT_NE(makeDetector(config), nullptr);
      EXPECT_THROW(makeWholeDriveDetector(config), std::invalid_argument) << info.name;
    }
  }
  EXPECT_GE(names.size(), 7U);
  EXPECT_THROW(infoOf(static_cast<Method>(names.size())), std::out_of_range);
}

Scan single(double stamp, const Eigen::Vector3f& echo) {
  Scan scan;
  scan.stamp = stamp;
  scan.echoes = {echo};
  return scan;
}

TEST(RangeResidual, IsTheDifferenceRelativeToTheRange) {
  EchoLabels labels;
  for (const auto& [range, is_dynamic] : {std::pair{20.5F, 0}, {21.5F, 1}, {19.4F, 0}, {18.0F, 1}}) {
    const auto detector = makeDetector(configOf(Method::kRangeResidual));
    detector->process(single(1.0, {20.0F, 0.01F, 0.01F}), labels);
    detector->process(single(1.1, {range, 0.01F, 0.01F}), labels);
    EXPECT_EQ(labels.dynamic[0], is_dynamic) << range;  // the threshold is 5 %
    EXPECT_EQ(labels.observed[0], 1);
  }
}

TEST(RangeResidual, TheLastScanIsMovedIntoThePresentFrame) {
  const auto detector = makeDetector(configOf(Method::kRangeResidual));
  EchoLabels labels;
  detector->process(single(1.0, {20.0F, 0.01F, 0.01F}), labels);
  Scan later = single(1.1, {17.0F, 0.01F, 0.01F});
  later.odom_from_base.translation().x() = 3.0;
  detector->process(later, labels);
  EXPECT_EQ(labels.dynamic[0], 0);
}

TEST(RayTracing, BehindASurfaceNothingIsKnown) {
  const auto detector = makeDetector(configOf(Method::kRayTracing));
  EchoLabels labels;
  detector->process(lookAround(1.0, 8.0, 0.0), labels);
  const Scan revealed = lookAround(1.1, 100.0, 0.0);  // the post is gone: the wall behind it is seen for the first time
  detector->process(revealed, labels);
  int behind = 0;
  for (std::size_t i = 0; i < revealed.echoes.size(); ++i) {
    const Eigen::Vector3f& echo = revealed.echoes[i];
    const bool was_hidden = std::abs(std::atan2(echo.y(), echo.x())) < 0.015F && echo.x() > 14.0F;
    if (!was_hidden) continue;
    ++behind;
    EXPECT_EQ(labels.dynamic[i], 0);
    EXPECT_EQ(labels.observed[i], 0);
  }
  EXPECT_GT(behind, 10);
}

TEST(RegionPlanes, FollowASlopeRegionByRegion) {
  const auto height = [](double x) { return x < 10.0 ? 0.0 : 0.04 * (x - 10.0); };
  std::vector<Eigen::Vector3f> points;
  for (double x = -60.0; x <= 60.0; x += 0.5) {
    for (double y = -60.0; y <= 60.0; y += 0.5) points.push_back(Eigen::Vector3d(x, y, height(x) - 1.7).cast<float>());
  }
  const std::size_t ground = points.size();
  for (double z = 0.0; z < 2.0; z += 0.1) {
    for (double y = -3.0; y < 3.0; y += 0.1) {
      points.push_back(Eigen::Vector3d(20.0, y, height(20.0) - 1.7 + z).cast<float>());
    }
  }
  RegionPlanes planes;
  planes.fit(Eigen::Vector3f::Zero(), points, std::vector<std::uint8_t>(points.size(), 1));
  // A region across the kink has one plane all the same; to the sides it takes what most of it is.
  for (std::size_t i = 0; i < ground; ++i) {
    const bool is_ahead_or_behind = std::abs(points[i].y()) < std::abs(points[i].x());
    if (is_ahead_or_behind) {
      EXPECT_NEAR(planes.heightOf(points[i]), 0.0F, 0.25F) << points[i].transpose();
    }
  }
  EXPECT_NEAR(planes.heightOf({20.0F, 1.0F, 0.7F}), 2.0F, 0.15F);
}

TEST(RegionPlanes, ARaisedPlateIsNoGround) {
  std::vector<Eigen::Vector3f> points;
  for (double x = -10.0; x <= 20.0; x += 0.2) {
    for (double y = -2.0; y <= 2.0; y += 0.2) {
      const bool is_roof = x > 12.0;  // covers the ground there wholly
      points.push_back(Eigen::Vector3d(x, y, is_roof ? -0.5 : -1.7).cast<float>());
    }
  }
  RegionPlanes planes;
  planes.fit(Eigen::Vector3f::Zero(), points, std::vector<std::uint8_t>(points.size(), 1));
  EXPECT_NEAR(planes.heightOf({16.0F, 0.5F, -0.5F}), 1.2F, 0.15F);
}

}  // namespace
}  // namespace donex
