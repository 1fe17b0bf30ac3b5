// The ground under a vehicle: found where it is, not where something stands on it.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/evidence/ground.h"
#include "support/ground_oracle.h"
#include "support/height_world.h"

namespace donex {
namespace {

using testing::Block;
using testing::HeightWorld;

constexpr double kReach = 30.0;
constexpr double kMount = 1.8;       // [m] above the ground
constexpr float kClearance = 0.25F;  // as the default configuration has it

class GroundUnder {
 public:
  explicit GroundUnder(HeightWorld world, std::vector<Eigen::Vector3f> stray = {}) : world_(std::move(world)) {
    const Eigen::Vector3d sensor(0.3, -0.2, world_.ground(0.3, -0.2) + kMount);
    echoes_ = world_.seenFrom(sensor, 1.2 * kReach);
    echoes_.insert(echoes_.end(), stray.begin(), stray.end());
    ground_.estimate(sensor.cast<float>(), echoes_, std::vector<std::uint8_t>(echoes_.size(), 1));
  }

  /// Share of the echoes on the bare ground that are taken for ground, or of those well on a block that are not.
  double rightOnGround() const { return share(false); }
  double rightOnBlocks() const { return share(true); }

  float heightOf(double x, double y, double z) const {
    return ground_.heightOf(Eigen::Vector3d(x, y, z).cast<float>());
  }

 private:
  bool isOnBlock(const Eigen::Vector3f& echo) const {
    for (const Block& block : world_.blocks) {
      const Block grown{block.x_min - 0.1, block.x_max + 0.1, block.y_min - 0.1, block.y_max + 0.1, 0.0};
      if (grown.holds(echo.x(), echo.y())) return true;
    }
    return false;
  }

  double share(bool on_blocks) const {
    int right = 0, all = 0;
    for (const Eigen::Vector3f& echo : echoes_) {
      const double rise = echo.z() - world_.ground(echo.x(), echo.y());
      const bool asked = std::isfinite(ground_.heightOf(echo)) && rise > -0.3 &&
                         (on_blocks ? isOnBlock(echo) && rise > 0.6 : !isOnBlock(echo));
      if (!asked) continue;
      ++all;
      right += (ground_.heightOf(echo) > kClearance) == on_blocks ? 1 : 0;
    }
    EXPECT_GT(all, 100) << "nothing to judge";
    return static_cast<double>(right) / all;
  }

  HeightWorld world_;
  std::vector<Eigen::Vector3f> echoes_;
  Ground ground_{kReach};
};

HeightWorld sloping(double x_slope, double y_slope) {
  HeightWorld world;
  world.ground = [=](double x, double y) { return x_slope * x + y_slope * y; };
  return world;
}

TEST(Ground, FlatGroundIsGroundAndHeightsAreAboveIt) {
  const GroundUnder ground{HeightWorld{}};
  EXPECT_EQ(ground.rightOnGround(), 1.0);
  for (const double x : {-20.0, -3.0, 0.0, 8.0, 25.0}) EXPECT_NEAR(ground.heightOf(x, 2.0, 1.5), 1.5F, 0.1F) << x;
}

TEST(Ground, SlopesOfTenPercent) {
  for (const auto& [x, y] : {std::pair{0.1, 0.0}, {-0.1, 0.0}, {0.0, 0.1}, {0.07, -0.07}}) {
    EXPECT_GT(GroundUnder(sloping(x, y)).rightOnGround(), 0.97) << x << ' ' << y;
  }
}

TEST(Ground, SlopesThatNoCellAlongsideWouldFollow) {
  for (const auto& [x, y] : {std::pair{0.15, 0.0}, {0.0, -0.15}}) {
    EXPECT_GT(GroundUnder(sloping(x, y)).rightOnGround(), 0.95) << x << ' ' << y;
  }
}

TEST(Ground, AKerbIsGround) {
  HeightWorld world;
  world.ground = [](double, double y) { return std::abs(y) > 3.5 ? 0.12 : 0.0; };
  const GroundUnder ground(world);
  EXPECT_GT(ground.rightOnGround(), 0.99);
  EXPECT_NEAR(ground.heightOf(5.0, 8.0, 1.12), 1.0F, 0.13F) << "the pavement's own height";
}

TEST(Ground, ARaisedRoadAndWhatLiesBesideItAreGround) {
  for (const double slope : {0.12, -0.12}) {  // the land beside the road rises, or falls, by a metre over eight
    HeightWorld world;
    world.ground = [=](double, double y) { return slope * std::clamp(std::abs(y) - 4.0, 0.0, 8.0); };
    world.blocks = {{8.0, 12.5, -1.0, 0.8, 1.5}};
    const GroundUnder ground(world);
    EXPECT_GT(ground.rightOnGround(), 0.97) << slope;
    EXPECT_GT(ground.rightOnBlocks(), 0.99) << slope;
    EXPECT_NEAR(ground.heightOf(2.0, 0.0, 1.0), 1.0F, 0.1F);
    EXPECT_NEAR(ground.heightOf(2.0, 8.0, world.ground(2.0, 8.0) + 1.0), 1.0F, 0.2F);
  }
}

TEST(Ground, ACarStandingOnItIsNot) {
  HeightWorld world;
  world.blocks = {{8.0, 12.5, 1.0, 2.8, 1.5}, {-12.0, -7.5, -4.0, -2.2, 1.5}, {5.0, 9.5, -5.0, -3.2, 1.5}};
  const GroundUnder ground(world);
  EXPECT_GT(ground.rightOnGround(), 0.99);
  EXPECT_GT(ground.rightOnBlocks(), 0.99);
}

TEST(Ground, AHouseIsNotHoweverLarge) {
  HeightWorld world;
  world.blocks = {{-25.0, 25.0, 8.0, 28.0, 6.0}};
  const GroundUnder ground(world);
  EXPECT_GT(ground.rightOnGround(), 0.99);
  EXPECT_GT(ground.rightOnBlocks(), 0.99);
}

TEST(Ground, ALorryRightBesideTheSensorIsNot) {
  HeightWorld world;
  world.blocks = {{-6.0, 6.0, 1.6, 4.1, 1.6}, {-4.0, 1.0, -3.6, -1.8, 1.5}};
  const GroundUnder ground(world);
  EXPECT_GT(ground.rightOnGround(), 0.98);
  EXPECT_GT(ground.rightOnBlocks(), 0.98);
}

TEST(Ground, OnASlopeCarsStillStandOut) {
  HeightWorld world = sloping(0.1, 0.02);
  world.blocks = {{8.0, 12.5, 1.0, 2.8, 1.5}, {-14.0, -9.5, -2.0, -0.2, 1.5}};
  const GroundUnder ground(world);
  EXPECT_GT(ground.rightOnGround(), 0.97);
  EXPECT_GT(ground.rightOnBlocks(), 0.98);
}

TEST(Ground, StrayEchoesBeneathItDoNotPullItDown) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> place(-25.0F, 25.0F), depth(-6.0F, -1.5F);
  std::vector<Eigen::Vector3f> stray;
  for (int i = 0; i < 150; ++i) {
    const float x = place(random), y = place(random);
    stray.emplace_back(x, y, depth(random));  // mirrored in puddles and windows
  }
  HeightWorld world;
  world.blocks = {{8.0, 12.5, 1.0, 2.8, 1.5}};
  const GroundUnder ground(world, stray);
  EXPECT_GT(ground.rightOnGround(), 0.99);
  EXPECT_GT(ground.rightOnBlocks(), 0.99);
}

TEST(Ground, IsFoundByASensorThatHardlyLooksDown) {
  // It sees the ground from 15 m on; nearby there are only the upper parts of what stands there.
  HeightWorld world;
  for (const double x : {-6.0, -3.5, 3.0, 5.5}) {
    for (const double y : {-5.0, -2.5, 2.5, 4.0}) world.blocks.push_back({x, x + 0.6, y, y + 0.6, 2.2});
  }
  const Eigen::Vector3d sensor(0.3, -0.2, kMount);
  std::vector<Eigen::Vector3f> echoes;
  for (const Eigen::Vector3f& echo : world.seenFrom(sensor, 1.2 * kReach)) {
    const Eigen::Vector3f ray = echo - sensor.cast<float>();
    if (ray.z() > -0.12F * ray.head<2>().norm()) echoes.push_back(echo);
  }
  Ground ground(kReach);
  ground.estimate(sensor.cast<float>(), echoes, std::vector<std::uint8_t>(echoes.size(), 1));
  int on_ground = 0;
  for (const Eigen::Vector3f& echo : echoes) {
    if (echo.z() > 0.01F || std::isinf(ground.heightOf(echo))) continue;
    ++on_ground;
    EXPECT_NEAR(ground.heightOf(echo), 0.0F, 0.1F) << echo.transpose();
  }
  EXPECT_GT(on_ground, 1000);
}

TEST(Ground, HeightIsInfiniteWhereNothingIsKnown) {
  const Ground never_asked(kReach);
  EXPECT_EQ(never_asked.heightOf({1.0F, 1.0F, 0.0F}), std::numeric_limits<float>::infinity());

  const GroundUnder ground{HeightWorld{}};
  EXPECT_EQ(ground.heightOf(kReach + 2.0, 0.0, 1.0), std::numeric_limits<float>::infinity()) << "outside the map";
  EXPECT_TRUE(std::isfinite(ground.heightOf(kReach - 2.0, 0.0, 1.0)));
}

TEST(Ground, EchoesThatAreNoneAndEmptyScansTellNothing) {
  const std::vector<Eigen::Vector3f> echoes = HeightWorld{}.seenFrom({0.0, 0.0, kMount}, 10.0);
  Ground ground(kReach);
  ground.estimate({0.0F, 0.0F, 1.8F}, echoes, std::vector<std::uint8_t>(echoes.size(), 1));
  EXPECT_TRUE(std::isfinite(ground.heightOf({5.0F, 0.0F, 0.0F})));
  ground.estimate({0.0F, 0.0F, 1.8F}, echoes, std::vector<std::uint8_t>(echoes.size(), 0));
  EXPECT_FALSE(std::isfinite(ground.heightOf({5.0F, 0.0F, 0.0F}))) << "the scan before is forgotten";
}

/// Turns of a sensor that moves and publishes sectors, in a frame that jumps ahead with it.
class GroundInParts {
 public:
  GroundInParts(HeightWorld world, int parts) : world_(std::move(world)), parts_(parts) {}

  /// The sensor's next turn. Calls visit(echo in the world, its height above the ground) as the parts are judged.
  template <class Visit>
  void turn(Visit&& visit) {
    const Eigen::Vector3d sensor(1.3 * turns_, 0.4 * turns_, world_.ground(1.3 * turns_, 0.4 * turns_) + kMount);
    const std::vector<Eigen::Vector3f> seen = world_.seenFrom(sensor, 1.2 * kReach);
    for (int part = 0; part < parts_; ++part) {
      const Eigen::Vector3d origin(0.7 * (turns_ + part % 3), -0.7 * turns_, 0.7 * (part % 2));
      std::vector<Eigen::Vector3f> echoes;
      for (const Eigen::Vector3f& echo : seen) {
        const Eigen::Vector2d away = echo.head<2>().cast<double>() - sensor.head<2>();
        const double turn = std::atan2(away.y(), away.x()) / (2.0 * M_PI) + 0.5;
        if (std::min(static_cast<int>(turn * parts_), parts_ - 1) != part) continue;
        echoes.push_back(echo - origin.cast<float>());
      }
      const TurnPart begins = turns_ == 0 ? TurnPart::kWhole : TurnPart::kFirst;
      ground_.estimate(part == 0 ? begins : TurnPart::kContinuing, origin, (sensor - origin).cast<float>(), echoes,
                       std::vector<std::uint8_t>(echoes.size(), 1));
      for (std::size_t i = 0; i < echoes.size(); ++i) {
        const float height = ground_.heightOfEcho(i, echoes[i].z());
        ASSERT_EQ(height, ground_.heightOf(echoes[i]));
        visit(Eigen::Vector3f(echoes[i] + origin.cast<float>()), height);
      }
    }
    ++turns_;
  }

 private:
  HeightWorld world_;
  int parts_;
  int turns_ = 0;
  Ground ground_{kReach};
};

TEST(Ground, PartsOfATurnFindTheGroundThatTheWholeHas) {
  for (const int parts : {2, 4, 10, 40}) {
    HeightWorld world = sloping(0.05, -0.04);
    world.blocks = {{4.0, 9.0, -8.0, -2.0, 2.0}, {-20.0, -12.0, 3.0, 6.0, 3.0}, {15.0, 19.0, 2.0, 4.0, 1.5}};
    GroundInParts ground(world, parts);
    ground.turn([](const Eigen::Vector3f&, float) {});
    for (int turn = 1; turn < 4; ++turn) {
      int all = 0, right = 0;
      ground.turn([&](const Eigen::Vector3f& echo, float height) {
        const double rise = echo.z() - world.ground(echo.x(), echo.y());
        const bool is_told = std::isfinite(height) && (rise < 0.05 || rise > 0.6);
        all += is_told ? 1 : 0;
        right += is_told && (height > kClearance) == (rise > 0.6) ? 1 : 0;
      });
      EXPECT_GT(all, 1000);
      EXPECT_GE(right, 0.995 * all) << parts << " parts, turn " << turn;
    }
  }
}

TEST(Ground, APartThatShowsNoGroundHasThatOfTheTurnBefore) {
  Ground ground(kReach);
  const Eigen::Vector3f sensor(0.0F, 0.0F, 1.8F);
  const std::vector<Eigen::Vector3f> road = HeightWorld{}.seenFrom({0.0, 0.0, kMount}, 20.0);
  ground.estimate(TurnPart::kWhole, Eigen::Vector3d::Zero(), sensor, road, std::vector<std::uint8_t>(road.size(), 1));
  const std::vector<Eigen::Vector3f> side_of_a_lorry = {{7.0F, 0.1F, 1.0F}, {7.0F, 0.3F, 2.0F}, {7.0F, 0.5F, 3.0F}};
  const std::vector<std::uint8_t> all(side_of_a_lorry.size(), 1);
  ground.estimate(TurnPart::kFirst, Eigen::Vector3d::Zero(), sensor, side_of_a_lorry, all);
  EXPECT_NEAR(ground.heightOf(side_of_a_lorry[0]), 1.0F, 0.1F);
  ground.estimate(TurnPart::kContinuing, Eigen::Vector3d::Zero(), sensor, side_of_a_lorry, all);
  EXPECT_NEAR(ground.heightOf(side_of_a_lorry[0]), 1.0F, 0.1F);
}

/// A rough world around a sensor somewhere: echoes of the ground, of objects on it, stray ones, and invalid ones.
struct RandomScan {
  explicit RandomScan(unsigned seed) {
    std::mt19937 random(seed);
    const auto draw = [&](float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); };
    sensor = {draw(-50.0F, 50.0F), draw(-50.0F, 50.0F), draw(-5.0F, 5.0F)};
    const float x_slope = draw(-0.12F, 0.12F), y_slope = draw(-0.12F, 0.12F), roughness = draw(0.0F, 0.3F);
    const int count = seed % 4 == 0 ? 60 : 6000;  // few: most cells hold no echo
    for (int i = 0; i < count; ++i) {
      const float reach = draw(0.0F, 1.0F) < 0.3F ? 8.0F : 1.2F * static_cast<float>(kReach);
      const float x = draw(-reach, reach), y = draw(-reach, reach);
      const float kind = draw(0.0F, 1.0F);
      const bool on_thing = std::sin(0.7F * x) * std::sin(0.5F * y) > 0.5F;
      const float above = kind < 0.02F ? -draw(0.0F, 4.0F) : on_thing ? draw(0.1F, 2.0F) : draw(0.0F, roughness);
      const float z = -1.8F + x_slope * x + y_slope * y + above;
      echoes.emplace_back(sensor + Eigen::Vector3f(x, y, kind > 0.99F ? std::nanf("") : z));
      is_echo.push_back(kind > 0.95F ? 0 : 1);
    }
  }

  Eigen::Vector3f sensor;
  std::vector<Eigen::Vector3f> echoes;
  std::vector<std::uint8_t> is_echo;
};

TEST(Ground, IsThatOfItsDefinition) {
  int continued = 0, interrupted = 0, outside = 0;
  Ground ground(kReach);  // one for all scans: nothing of the one before is left
  for (unsigned seed = 1; seed <= 24; ++seed) {
    const RandomScan scan(seed);
    ground.estimate(scan.sensor, scan.echoes, scan.is_echo);
    oracle::GroundMap map(kReach, scan.sensor, scan.echoes, scan.is_echo);
    for (std::size_t i = 0; i < scan.echoes.size(); ++i) {
      if (scan.is_echo[i] == 0) continue;
      const float height = ground.heightOfEcho(i, scan.echoes[i].z());
      const double expected = map.heightOf(scan.echoes[i]);
      outside += std::isinf(expected) ? 1 : 0;
      ASSERT_EQ(std::isinf(height), std::isinf(expected));
      ASSERT_EQ(height, ground.heightOf(scan.echoes[i]));
      if (std::isinf(expected)) continue;
      ASSERT_NEAR(height, expected, 1e-3) << "seed " << seed << " echo " << i;
    }
    continued += map.continued();
    interrupted += map.interrupted();
  }
  EXPECT_GT(continued, 5000);
  EXPECT_GT(interrupted, 1000);
  EXPECT_GT(outside, 1000);
}

}  // namespace
}  // namespace donex
