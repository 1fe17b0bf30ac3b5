// Peopleremover against its definition, on hand-made and on random scenes.
#include <gtest/gtest.h>

#include "core/methods/people_remover.h"
#include "core/methods/point_shadows.h"
#include "support/people_remover_oracle.h"
#include "support/random_scans.h"

namespace donex {
namespace {

using Labels = std::vector<std::vector<std::uint8_t>>;

Config smallRegion(double voxel_size) {
  Config config;
  config.method = Method::kPeopleremover;
  config.voxel_size = voxel_size;
  config.region = {-8.0, 8.0, -8.0, 8.0, -4.0, 4.0};
  return config;
}

Labels labelsOf(WholeDriveDetector& detector, const std::vector<Scan>& scans) {
  Labels labels;
  do {
    for (const Scan& scan : scans) {
      EchoLabels one;
      detector.process(scan, one);
      EXPECT_EQ(one.dynamic.size(), scan.echoes.size());
      if (detector.isLastPass()) labels.push_back(one.dynamic);
    }
  } while (detector.nextPass());
  return labels;
}

Scan scanAt(double stamp, std::vector<Eigen::Vector3f> echoes) {
  Scan scan;
  scan.stamp = stamp;
  scan.echoes = std::move(echoes);
  return scan;
}

struct RandomCase {
  double voxel_size;
  PeopleRemoverOptions options;
};

class RandomScenes : public ::testing::TestWithParam<RandomCase> {};

/// A few walls' worth of echoes: scattered ones alone have no surfaces, and no shadows but their own.
void addWall(Scan& scan, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> noise(-0.02F, 0.02F);
  const float distance = 3.0F + static_cast<float>(random() % 4);
  for (float y = -2.0F; y < 2.0F; y += 0.25F) {
    for (float z = -1.0F; z < 1.0F; z += 0.25F) scan.echoes.emplace_back(distance + noise(random), y, z);
  }
}

TEST_P(RandomScenes, EqualTheDefinitionEchoByEcho) {
  const Config config = smallRegion(GetParam().voxel_size);
  std::size_t dynamic = 0, fixed = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    std::vector<Scan> scans;
    testing::RandomScans source(seed, config.voxel_size, 9.0F);
    for (int k = 0; k < 7; ++k) {
      scans.push_back(source.next(160));
      if (k % 2 == 0) addWall(scans.back(), seed + static_cast<unsigned>(k));
    }
    const auto detector = makePeopleRemover(config, GetParam().options);
    const Labels labels = labelsOf(*detector, scans);
    oracle::PeopleRemover oracle(config, GetParam().options);
    ASSERT_EQ(labels, oracle.label(scans)) << "seed " << seed;
    for (const auto& scan : labels) {
      const auto moving = static_cast<std::size_t>(std::count(scan.begin(), scan.end(), 1));
      dynamic += moving;
      fixed += scan.size() - moving;
    }
  }
  EXPECT_GT(dynamic, 50U) << "a test of nothing";
  EXPECT_GT(fixed, 1000U);
}

INSTANTIATE_TEST_SUITE_P(Options, RandomScenes,
                         ::testing::Values(RandomCase{0.5, {}}, RandomCase{0.5, {0, false, 0.0, 1, false}},
                                           RandomCase{0.3, {1, true, 0.1, 3, true}},
                                           RandomCase{0.8, {2, true, 0.0, 5, false}},
                                           RandomCase{0.5, {0, false, 0.0, 5, true}}));

TEST(PointShadows, EqualTheDefinitionOnRandomEchoes) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    testing::RandomScans source(seed, 0.4, 12.0F);
    Scan scan = source.next(400);
    addWall(scan, seed);
    std::vector<std::uint8_t> is_echo;
    for (const auto& echo : scan.echoes) is_echo.push_back(echo.allFinite() && echo.norm() > 0.7F ? 1 : 0);
    PointShadows shadows(0.7F, 0.05F);
    EXPECT_EQ(shadows.cast(scan.echoes, is_echo), oracle::PeopleRemover::shadows(scan.echoes, is_echo, 0.7F, 0.05F));
  }
}

TEST(PointShadows, EndALineOfSightOneDiagonalBeforeAWall) {
  std::vector<Eigen::Vector3f> wall;
  for (float y = -20.0F; y <= 20.0F; ++y) {
    for (float z = -20.0F; z <= 20.0F; ++z) wall.emplace_back(10.0F, 0.1F * y, 0.1F * z);
  }
  PointShadows shadows(0.5F, 0.0F);
  const auto& most = shadows.cast(wall, std::vector<std::uint8_t>(wall.size(), 1));
  for (std::size_t i = 0; i < wall.size(); ++i) {
    EXPECT_NEAR(most[i] * wall[i].x() / wall[i].norm(), 9.5F, 1e-3F) << i;
  }
}

TEST(PointShadows, TheAngleIsTwiceTheVoxelsOwn) {
  EXPECT_DOUBLE_EQ(PointShadows::angleAt(3.0, 1.0), 2.0 * std::asin(0.5));
  EXPECT_DOUBLE_EQ(PointShadows::angleAt(1.5, 1.0), M_PI);  // the sensor is inside the voxel's circumsphere
}

/// A wall of 1 m voxels, and an object before it in the first scan only.
TEST(PeopleRemover, WhatAnotherScanSeesThroughIsDynamic) {
  Config config = smallRegion(1.0);
  PeopleRemoverOptions options;
  options.min_cluster = 1;
  options.point_shadows = options.subvoxel = false;
  const Eigen::Vector3f object(3.5F, 0.5F, 0.5F), wall(6.5F, 0.5F, 0.5F), aside(3.5F, 3.5F, 0.5F);
  const std::vector<Scan> scans{scanAt(1.0, {object, aside}), scanAt(1.1, {wall})};
  EXPECT_EQ(labelsOf(*makePeopleRemover(config, options), scans), (Labels{{1, 0}, {0}}));
  options.min_cluster = 2;  // one free voxel alone is noise
  EXPECT_EQ(labelsOf(*makePeopleRemover(config, options), scans), (Labels{{0, 0}, {0}}));
  options.min_cluster = 1;
  options.diff = 1;  // the two scans are one view
  EXPECT_EQ(labelsOf(*makePeopleRemover(config, options), scans), (Labels{{0, 0}, {0}}));
}

TEST(PeopleRemover, WhereTheOdometryFrameBeginsDoesNotMatter) {
  PeopleRemoverOptions options;
  options.min_cluster = 1;
  options.point_shadows = options.subvoxel = false;
  std::vector<Scan> scans{scanAt(1.0, {{3.5F, 0.5F, 0.5F}, {3.5F, 3.5F, 0.5F}}), scanAt(1.1, {{6.5F, 0.5F, 0.5F}})};
  // As UTM has it: more voxels away than a key has bits for.
  for (Scan& scan : scans) scan.odom_from_base.translation() = Eigen::Vector3d(5e5, 5.4e6, 100.0);
  EXPECT_EQ(labelsOf(*makePeopleRemover(smallRegion(1.0), options), scans), (Labels{{1, 0}, {0}}));
}

TEST(PeopleRemover, ItsOwnEchoEndsALineOfSight) {
  PeopleRemoverOptions options;
  options.min_cluster = 1;
  options.point_shadows = options.subvoxel = false;
  const Eigen::Vector3f near_one(2.5F, 0.5F, 0.5F), middle(4.5F, 0.5F, 0.5F), wall(6.5F, 0.5F, 0.5F);
  // The second scan has an echo before the first one's place: what lies behind its voxel it does not see. The first
  // scan sees through that voxel.
  const std::vector<Scan> scans{scanAt(1.0, {middle}), scanAt(1.1, {near_one, wall})};
  EXPECT_EQ(labelsOf(*makePeopleRemover(smallRegion(1.0), options), scans), (Labels{{0}, {1, 0}}));
}

TEST(PeopleRemover, TheSameScansNextToAFreeVoxelAreDynamicToo) {
  PeopleRemoverOptions options;
  options.min_cluster = 1;
  options.point_shadows = false;
  const Eigen::Vector3f object(3.5F, 0.5F, 0.5F), skin(3.5F, 2.5F, 0.5F), far_part(3.5F, 3.5F, 0.5F);
  const std::vector<Scan> scans{scanAt(1.0, {object, skin, far_part}), scanAt(1.1, {{6.5F, 0.5F, 0.5F}, skin})};
  EXPECT_EQ(labelsOf(*makePeopleRemover(smallRegion(1.0), options), scans), (Labels{{1, 1, 0}, {0, 0}}));
}

TEST(PeopleRemover, CannotRunLive) {
  const Config config = smallRegion(0.5);
  try {
    makeDetector(config);
    FAIL() << "it was built";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("cannot run live"), std::string::npos) << error.what();
  }
  Config live;
  EXPECT_THROW(makeWholeDriveDetector(live), std::invalid_argument);
  live.voxel_size = 99.0;
  EXPECT_THROW(makeWholeDriveDetector(live), std::invalid_argument);
}

TEST(PeopleRemover, ADriveCannotBeginAnew) {
  const auto detector = makeWholeDriveDetector(smallRegion(0.5));
  detector->reset();  // nothing has been taken yet
  EchoLabels labels;
  detector->process(scanAt(1.0, {{3.0F, 0.0F, 0.0F}}), labels);
  EXPECT_THROW(detector->reset(), std::logic_error);
}

}  // namespace
}  // namespace donex
