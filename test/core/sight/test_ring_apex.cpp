// The place where the rings of a cloud meet, on a room whose rings are exact, and where nothing can be told.
#include <cmath>
#include <limits>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/sight/ring_apex.h"
#include "support/room_of_rings.h"

namespace donex {
namespace {

using testing::RingedCloud;
using testing::ringsIn;
using testing::Room;

Eigen::Isometry3f mounting(float pitch = 0.0F) {
  return Eigen::Translation3f(1.1F, -0.4F, 1.73F) *
         Eigen::Isometry3f(Eigen::AngleAxisf(pitch, Eigen::Vector3f::UnitY()));
}

void expectFound(const RingedCloud& cloud, const Eigen::Vector3f& place, double tolerance) {
  const auto apex = findRingApex(cloud.echoes, cloud.rings);
  ASSERT_TRUE(apex);
  EXPECT_LT((*apex - place.cast<double>()).norm(), tolerance) << apex->transpose();
}

TEST(RingApex, LiesWhereTheSensorIs) {
  expectFound(ringsIn(Room::kWithWalls, Eigen::Isometry3f::Identity()), Eigen::Vector3f::Zero(), 1e-4);
  expectFound(ringsIn(Room::kWithWalls, mounting()), mounting().translation(), 1e-4);
}

TEST(RingApex, LiesThereForASensorThatLeans) {
  expectFound(ringsIn(Room::kWithWalls, mounting(0.3F)), mounting().translation(), 1e-4);
}

TEST(RingApex, HoldsAgainstNoiseAndStrangeEchoes) {
  RingedCloud cloud = ringsIn(Room::kWithWalls, mounting());
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0.0F, 0.005F);
  std::uniform_real_distribution<float> anywhere(-10.0F, 10.0F);
  for (std::size_t i = 0; i < cloud.echoes.size(); ++i) {
    Eigen::Vector3f& echo = cloud.echoes[i];
    echo += Eigen::Vector3f(noise(random), noise(random), noise(random));
    if (i % 20 == 0) echo = {anywhere(random), anywhere(random), anywhere(random)};
    if (i % 31 == 0) echo.setConstant(std::numeric_limits<float>::quiet_NaN());
  }
  expectFound(cloud, mounting().translation(), 0.02);
}

TEST(RingApex, IsNotToldByFlatGroundAlone) {
  const RingedCloud cloud = ringsIn(Room::kFloorAlone, mounting());
  EXPECT_FALSE(findRingApex(cloud.echoes, cloud.rings)) << "circles on a plane lie on cones of any height";
}

TEST(RingApex, IsNotToldByTwoSensorsInOneCloud) {
  RingedCloud cloud = ringsIn(Room::kWithWalls, mounting());
  const RingedCloud other = ringsIn(Room::kWithWalls, Eigen::Isometry3f(Eigen::Translation3f(-1.0F, 0.5F, 1.0F)));
  cloud.echoes.insert(cloud.echoes.end(), other.echoes.begin(), other.echoes.end());
  cloud.rings.insert(cloud.rings.end(), other.rings.begin(), other.rings.end());
  EXPECT_FALSE(findRingApex(cloud.echoes, cloud.rings));
}

TEST(RingApex, IsNotToldByRingsThatAreNone) {
  RingedCloud cloud = ringsIn(Room::kWithWalls, mounting());
  for (std::size_t i = 0; i < cloud.rings.size(); ++i) cloud.rings[i] = static_cast<std::uint32_t>(i % 16);
  EXPECT_FALSE(findRingApex(cloud.echoes, cloud.rings));
  EXPECT_FALSE(findRingApex({}, {}));
  EXPECT_FALSE(findRingApex({Eigen::Vector3f::Ones()}, {3U}));
  const std::vector<Eigen::Vector3f> alike(1000, Eigen::Vector3f::Ones());
  EXPECT_FALSE(findRingApex(alike, std::vector<std::uint32_t>(1000, 1U)));
}

}  // namespace
}  // namespace donex
