// Maps of static echoes and their scores, by hand.
#include <cmath>
#include <fstream>
#include <random>

#include <gtest/gtest.h>
#include <unistd.h>

#include "evaluation/map_score.h"
#include "io/static_map.h"
#include "support/temporary_directory.h"

namespace donex {
namespace {

namespace fs = std::filesystem;

/// The points of a PCD, read by its header alone.
std::vector<Eigen::Vector3f> readPcd(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string line;
  std::size_t points = 0, width = 0;
  while (std::getline(stream, line) && line != "DATA binary") {
    std::istringstream words(line);
    std::string name;
    words >> name;
    if (name == "POINTS") words >> points;
    if (name == "WIDTH") words >> width;
    const bool are_fields = name == "FIELDS";
    EXPECT_TRUE(!are_fields || line == "FIELDS x y z") << line;
  }
  EXPECT_EQ(points, width);
  std::vector<Eigen::Vector3f> result(points);
  for (auto& point : result) stream.read(reinterpret_cast<char*>(point.data()), 3 * sizeof(float));
  EXPECT_TRUE(stream) << "fewer points than the header says";
  EXPECT_EQ(stream.peek(), std::char_traits<char>::eof()) << "more points than the header says";
  return result;
}

TEST(StaticMap, AVoxelIsTheMeanOfItsPoints) {
  const test::TemporaryDirectory directory;
  const fs::path file = directory.path() / "map.pcd";
  StaticMap map(file, 0.5, 1000000);
  map.add({1.1, -0.2, 0.1});
  map.add({1.3, -0.4, 0.3});
  map.add({-3.0, 7.0, 0.0});
  EXPECT_EQ(map.write(), 2U);
  const auto points = readPcd(file);
  ASSERT_EQ(points.size(), 2U);
  EXPECT_LT((points[0] - Eigen::Vector3f(-3.0F, 7.0F, 0.0F)).norm(), 1e-5F);
  EXPECT_LT((points[1] - Eigen::Vector3f(1.2F, -0.3F, 0.2F)).norm(), 1e-5F);
}

/// A drive along x with a wall of voxels on both sides, back and forth.
std::vector<Eigen::Vector3f> mapOfDrive(const fs::path& file, std::size_t limit, std::size_t& peak,
                                        std::size_t& tiles) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> around(-20.0, 20.0);
  StaticMap map(file, 0.5, limit);
  peak = 0;
  for (int k = 0; k < 400; ++k) {
    const double x = k < 200 ? 2.0 * k : 2.0 * (400 - k);
    for (int i = 0; i < 300; ++i) map.add({x + around(random), around(random), 0.1 * around(random)});
    map.settle({x, 0.0, 0.0});
    peak = std::max(peak, map.memoryBytes());
  }
  tiles = map.tilesPutAway();
  map.write();
  return readPcd(file);
}

TEST(StaticMap, KeepsToItsMemoryAndLosesNothing) {
  const test::TemporaryDirectory directory;
  std::size_t peak = 0, tiles = 0;
  const auto whole = mapOfDrive(directory.path() / "whole.pcd", 1U << 30U, peak, tiles);
  EXPECT_EQ(tiles, 0U);
  EXPECT_GT(peak, 3000000U);
  const auto bounded = mapOfDrive(directory.path() / "bounded.pcd", 500000, peak, tiles);
  EXPECT_GT(tiles, 5U);
  EXPECT_LE(peak, 500000U);
  ASSERT_EQ(bounded.size(), whole.size());
  for (std::size_t i = 0; i < whole.size(); ++i) EXPECT_LT((bounded[i] - whole[i]).norm(), 1e-4F);
  EXPECT_EQ(std::distance(fs::directory_iterator(directory.path()), fs::directory_iterator()), 2) << "files are left";
}

TEST(StaticMap, BeginsNearAFarDrive) {
  const test::TemporaryDirectory directory;
  const fs::path file = directory.path() / "map.pcd";
  const Eigen::Vector3d utm(500123.4, 5400567.8, 120.0);
  StaticMap map(file, 0.1, 1000000);
  map.add(utm);
  map.add(utm + Eigen::Vector3d(0.3, -70.0, 1.0));  // in another tile
  EXPECT_EQ(map.write(), 2U);
  EXPECT_EQ(map.origin(), Eigen::Vector3d(500000.0, 5401000.0, 0.0));
  const auto points = readPcd(file);
  ASSERT_EQ(points.size(), 2U);
  const Eigen::Vector3f expected = (utm - map.origin()).cast<float>();
  EXPECT_LT((points[0] - expected - Eigen::Vector3f(0.3F, -70.0F, 1.0F)).norm(), 1e-3F);
  EXPECT_LT((points[1] - expected).norm(), 1e-3F);
}

/// Two clumps of voxels 200 m apart, the first of which is put away.
void fillTwice(StaticMap& map) {
  for (int i = 0; i < 200; ++i) map.add({0.1 * i + 0.05, 0.0, 0.0});
  for (int i = 0; i < 200; ++i) map.add({200.05 + 0.1 * i, 0.0, 0.0});
  map.settle({210.0, 0.0, 0.0});
}

TEST(StaticMap, IsEmptyOnceItIsWritten) {
  const test::TemporaryDirectory directory;
  StaticMap map(directory.path() / "map.pcd", 0.1, 1000);
  fillTwice(map);
  EXPECT_GT(map.tilesPutAway(), 0U);
  EXPECT_EQ(map.write(), 400U);
  EXPECT_EQ(map.write(), 0U);
}

TEST(StaticMap, AnothersLeftoversAreNotItsOwn) {
  const test::TemporaryDirectory directory;
  const fs::path file = directory.path() / "map.pcd";
  const auto stale = directory.path() / ("map.pcd." + std::to_string(getpid()) + ".0_0.part");
  std::ofstream(stale) << std::string(24, 'x');
  StaticMap map(file, 0.1, 1000);
  fillTwice(map);
  EXPECT_EQ(map.write(), 400U);
}

TEST(StaticMap, SaysWhatWasTakenFromIt) {
  const test::TemporaryDirectory directory;
  StaticMap map(directory.path() / "map.pcd", 0.1, 1000);
  fillTwice(map);
  for (const auto& entry : fs::directory_iterator(directory.path())) fs::resize_file(entry.path(), 30);
  EXPECT_THROW(map.write(), DataError);
}

TEST(StaticMap, SaysWhatItCannotWrite) {
  const test::TemporaryDirectory directory;
  StaticMap map(directory.path() / "none" / "map.pcd", 0.5, 1000000);
  map.add({1.0, 1.0, 1.0});
  EXPECT_THROW(map.write(), DataError);
}

TEST(MapScore, ByHand) {
  MapScore score(1.0);
  const auto add = [&](double x, int times, bool is_moving, bool is_kept) {
    for (int i = 0; i < times; ++i) score.add({x, 0.5, 0.5}, is_moving, is_kept);
  };
  add(0.5, 3, false, true);   // a static voxel, preserved
  add(1.5, 2, false, false);  // a static voxel, lost
  add(2.5, 4, true, false);   // a dynamic voxel, rejected
  add(3.5, 1, true, true);    // a dynamic voxel, one moving echo stays
  add(3.5, 3, true, false);
  add(4.5, 3, false, true);  // mostly static: preserved
  add(4.5, 1, true, true);
  const MapScore::Rates rates = score.rates();
  EXPECT_EQ(rates.static_voxels, 3U);
  EXPECT_EQ(rates.dynamic_voxels, 2U);
  EXPECT_DOUBLE_EQ(rates.preservation, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(rates.rejection, 0.5);
  EXPECT_DOUBLE_EQ(rates.f1, 2.0 * (2.0 / 3.0) * 0.5 / (2.0 / 3.0 + 0.5));
  EXPECT_DOUBLE_EQ(rates.static_accuracy, 6.0 / 8.0);
  EXPECT_DOUBLE_EQ(rates.dynamic_accuracy, 7.0 / 9.0);
  EXPECT_DOUBLE_EQ(rates.associated, std::sqrt(6.0 / 8.0 * 7.0 / 9.0));
}

TEST(MapScore, NothingToScoreIsNotANumber) {
  EXPECT_TRUE(std::isnan(MapScore().rates().preservation));
  EXPECT_TRUE(std::isnan(MapScore().rates().associated));
}

}  // namespace
}  // namespace donex
