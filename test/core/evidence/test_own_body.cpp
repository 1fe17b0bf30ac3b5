#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/evidence/own_body.h"

namespace donex {
namespace {

/// A vehicle that drives along x past a post every metre, with a sensor 1.7 m up and the own bonnet in sight.
class OwnBodyTest : public testing::Test {
 protected:
  Scan at(double way) const {
    Scan scan;
    scan.base_from_sensor.translation().z() = 1.7;
    scan.odom_from_base.translation().x() = way;
    scan.echoes.emplace_back(1.6F, 0.2F, -0.7F);                                           // bonnet
    scan.echoes.emplace_back(static_cast<float>(2.0 - std::fmod(way, 1.0)), 1.2F, -0.5F);  // a post
    scan.echoes.emplace_back(2.0F, -1.0F, -1.7F);                                          // the ground, always there
    scan.echoes.emplace_back(3.0F, 0.0F, -0.5F);                                           // a vehicle that is followed
    return scan;
  }

  std::vector<std::uint8_t> found(const OwnBody& body, const Scan& scan) const {
    std::vector<std::uint8_t> is_solid(scan.echoes.size(), 1), is_body;
    body.leaveOut(scan, 0, scan.echoes.size(), is_solid);
    for (const std::uint8_t solid : is_solid) is_body.push_back(solid != 0 ? 0 : 1);
    return is_body;
  }

  void drive(OwnBody& body, double from, double to, double step) const {
    for (double way = from; way < to; way += step) {
      learn(body, TurnPart::kWhole, at(way));
    }
  }

  static void learn(OwnBody& body, TurnPart part, const Scan& scan) {
    std::vector<float> heights;
    for (const Eigen::Vector3f& echo : scan.echoes) heights.push_back(echo.z() + 1.7F);
    body.learn(part, scan, std::vector<std::uint8_t>(scan.echoes.size(), 1), heights, 0.25F);
  }

  const std::vector<std::uint8_t> none_ = {0, 0, 0, 0}, bonnet_ = {1, 0, 0, 0};
};

TEST_F(OwnBodyTest, IsWhatStaysNearTheSensorWhileTheVehicleMoves) {
  OwnBody body{SelfConfig()};
  EXPECT_EQ(found(body, at(0.0)), none_);
  drive(body, 0.0, 0.5, 0.43);
  EXPECT_EQ(found(body, at(0.5)), none_) << "one place proves nothing";
  drive(body, 0.86, 1.3, 0.43);
  EXPECT_EQ(found(body, at(1.3)), bonnet_) << "hit from all of the first places";
  drive(body, 1.3, 5.0, 0.43);
  EXPECT_EQ(found(body, at(5.0)), bonnet_);
  body.reset();
  EXPECT_EQ(found(body, at(5.0)), none_);
}

TEST_F(OwnBodyTest, ScattersAboutWhatStays) {
  OwnBody body{SelfConfig()};
  Scan scan;
  const auto see = [&](const Eigen::Vector3f& echo) {
    scan = at(scan.odom_from_base.translation().x() + 0.43);
    scan.echoes = {echo};
    learn(body, TurnPart::kWhole, scan);
  };
  const Eigen::Vector3f bonnet(1.6F, 0.2F, -0.7F), above = bonnet + Eigen::Vector3f(0.0F, 0.0F, 0.15F);
  for (int place = 0; place < 10; ++place) see(bonnet);
  const auto isBody = [&](const Eigen::Vector3f& echo) {
    scan.echoes = {echo};
    return found(body, scan)[0] != 0;
  };
  EXPECT_TRUE(isBody(bonnet));
  EXPECT_FALSE(isBody(above)) << "nothing was there before";
  see(above);
  see(bonnet);
  EXPECT_TRUE(isBody(above)) << "hit once, beside what stays";
  const Eigen::Vector3f apart = bonnet + Eigen::Vector3f(0.0F, 0.0F, 0.45F);
  see(apart);
  see(bonnet);
  EXPECT_FALSE(isBody(apart));
}

TEST_F(OwnBodyTest, IsNotFoundAtRest) {
  OwnBody body{SelfConfig()};
  for (int i = 0; i < 50; ++i) drive(body, 0.0, 0.1, 0.2);
  EXPECT_EQ(found(body, at(0.0)), none_);
}

TEST_F(OwnBodyTest, IsFoundInPartsOfTurnsAndBySeveralSensors) {
  OwnBody body{SelfConfig()};
  for (double way = 0.0; way < 5.0; way += 0.43) {
    const Scan whole = at(way);
    Scan front = whole, rear = whole;
    front.echoes.assign(whole.echoes.begin(), whole.echoes.begin() + 1);
    rear.echoes.assign(whole.echoes.begin() + 1, whole.echoes.end());
    learn(body, TurnPart::kFirst, rear);
    learn(body, TurnPart::kContinuing, front);
  }
  EXPECT_EQ(found(body, at(5.0)), bonnet_);
  Scan by_another = at(5.0);
  by_another.base_from_sensor.translation().x() = 1.0;
  for (Eigen::Vector3f& echo : by_another.echoes) echo.x() -= 1.0F;
  EXPECT_EQ(found(body, by_another), bonnet_) << "the body is the vehicle's, not the sensor's";
}

TEST_F(OwnBodyTest, IsForgottenWhenItHasGone) {
  OwnBody body{SelfConfig()};
  drive(body, 0.0, 10.0, 0.43);
  Scan bare = at(0.0);
  bare.echoes.clear();
  for (double way = 10.0; way < 17.0; way += 0.43) {
    bare.odom_from_base.translation().x() = way;
    learn(body, TurnPart::kWhole, bare);
  }
  EXPECT_EQ(found(body, at(17.0)), none_);
}

TEST_F(OwnBodyTest, IsAlsoTheBoxThatIsGiven) {
  SelfConfig config;
  config.detection = false;
  config.x_max = 4.0;
  config.y_min = -0.1;
  config.y_max = 0.3;
  config.z_min = 0.9;
  config.z_max = 1.5;
  OwnBody body(config);
  drive(body, 0.0, 10.0, 0.43);
  EXPECT_EQ(found(body, at(0.0)), (std::vector<std::uint8_t>{1, 0, 0, 1}));
}

TEST_F(OwnBodyTest, NoEchoIsNoBody) {
  OwnBody body{SelfConfig()};
  Scan scan = at(0.0);
  scan.echoes.assign(2, Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
  EXPECT_EQ(found(body, scan), (std::vector<std::uint8_t>{0, 0}));
}

}  // namespace
}  // namespace donex
