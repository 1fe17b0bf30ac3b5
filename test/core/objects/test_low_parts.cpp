// Which low echoes move with what is close by: feet and wheels, not the ground beside them.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/methods/labelled_drives.h"
#include "core/objects/low_parts.h"
#include "core/objects/low_scene.h"
#include "support/low_parts_oracle.h"

namespace donex {
namespace {

using testing::kMount;
using testing::kReach;
using testing::labelsOf;
using testing::level;
using testing::LowScene;
using testing::simulatedDrive;
using testing::Surface;
using testing::TrueScan;

constexpr double kAhead = 8.0;  // [m]

/// A leg that walks, whose foot is not in it yet.
LowScene walker(Surface surface = level, double y = 0.1) {
  LowScene scene(std::move(surface));
  for (int i = 0; i < 10; ++i) scene.add(kAhead, y, 0.3 + 0.1 * i, Proof::kRearReceded);
  return scene;
}

TEST(LowParts, AFootMovesWhereAnEarlierScanSawThroughItsPlace) {
  LowScene scene = walker();
  const std::size_t foot = scene.add(kAhead, 0.5, 0.1);
  EXPECT_FALSE(scene.moves(foot)) << "nobody looked, and it does not touch the leg";
  scene.sawBareGround();  // 0.48 m behind it
  EXPECT_EQ(scene.joined()[foot], Proof::kRearReceded);
}

TEST(LowParts, OneOfManyScansThatSawThroughIsEnough) {
  LowScene scene = walker();
  const std::size_t foot = scene.add(kAhead, 0.2, 0.1);
  scene.sawBehind(foot, 0.0F);
  EXPECT_FALSE(scene.moves(foot)) << "a stone";
  scene.sawBehind(foot, 0.2F);
  EXPECT_FALSE(scene.moves(foot)) << "within the margin";
  scene.sawBehind(foot, 0.3F);
  scene.sawBehind(foot, 0.0F);
  EXPECT_TRUE(scene.moves(foot));
}

TEST(LowParts, NeitherTheGroundNorThePavementMovesUnderAPerson) {
  // The pavement ends 0.9 m to the right of who walks along.
  const Surface pavement = [](double, double y) { return y > -0.8 ? 0.12 : 0.0; };
  for (const Surface& surface : {Surface(level), pavement}) {
    LowScene scene = walker(surface);
    const std::size_t first = scene.proofs.size();
    for (const double x : {-0.3, -0.1, 0.0, 0.2}) {
      for (const double y : {-0.2, 0.0, 0.1, 0.3}) scene.add(kAhead + x, y, 0.01);
    }
    for (const bool saw : {false, true}) {
      if (saw) scene.sawBareGround();
      const std::vector<Proof> joined = scene.joined();
      for (std::size_t i = first; i < joined.size(); ++i) EXPECT_EQ(joined[i], Proof::kNone) << i << ' ' << saw;
    }
  }
}

TEST(LowParts, AnEchoThatIsNearerToWhatStandsDoesNotMove) {
  constexpr double kLeg = 0.95, kFoot = 1.25;
  for (const double pole : {1.35, 1.52, 1.7}) {
    LowScene scene = walker(level, kLeg);
    const std::size_t foot = scene.add(kAhead, kFoot, 0.1);
    scene.sawBareGround();
    ASSERT_TRUE(scene.moves(foot));
    scene.add(kAhead, pole, 1.0);
    EXPECT_EQ(scene.moves(foot), pole - kFoot > kFoot - kLeg) << "pole at " << pole;
  }
}

TEST(LowParts, WhereNobodyLookedAFootMovesThatStandsOutOfTheGroundToBothSides) {
  for (const auto& [ahead, across] : {std::pair{0.0, 0.0}, {0.05, 0.0}, {0.0, 0.05}, {0.0, -0.05}}) {
    LowScene scene = walker([ahead = ahead, across = across](double x, double y) { return ahead * x + across * y; });
    const std::size_t foot = scene.add(kAhead, 0.15, 0.18), ground = scene.add(kAhead, 0.0, 0.01);
    EXPECT_TRUE(scene.moves(foot)) << ahead << ' ' << across;
    EXPECT_FALSE(scene.moves(ground)) << ahead << ' ' << across;
  }
}

TEST(LowParts, AFootMovesThatWasTakenForTheGround) {
  LowScene scene = walker();
  const std::size_t foot = scene.add(kAhead, 0.1, 0.1);
  scene.findGround(0.7F);
  ASSERT_NEAR(scene.judged.heights[foot], 0.0F, 1e-3F);
  EXPECT_TRUE(scene.moves(foot));
}

TEST(LowParts, AnEchoThatIsMirroredFarBeneathTheGroundDoesNotMove) {
  for (const double height : {-0.05, -0.5}) {
    LowScene scene = walker();
    const std::size_t echo = scene.add(kAhead, 0.1, height);
    scene.sawBehind(echo, 1.0F);
    scene.judged.heights.assign(scene.proofs.size(), 1.0F);
    scene.judged.heights[echo] = static_cast<float>(height);
    scene.judged.roles.assign(scene.proofs.size(), ClusterRole::kNone);
    EXPECT_EQ(scene.moves(echo), height > -0.1) << height;
  }
}

TEST(LowParts, WithoutGroundNothingChanges) {
  LowScene scene = walker();
  scene.add(kAhead, 0.1, 0.1);
  scene.sawBareGround();
  EXPECT_NE(scene.joined(), scene.proofs);
  scene.judged.has_ground = false;
  EXPECT_EQ(scene.joined(), scene.proofs);
}

TEST(LowParts, WhereNothingMovesNothingChanges) {
  LowScene scene = walker();
  scene.add(kAhead, 0.1, 0.1);
  scene.sawBareGround();
  scene.proofs.assign(scene.proofs.size(), Proof::kNone);
  EXPECT_EQ(scene.joined(), scene.proofs);
}

TEST(LowParts, WhatIsOutsideTheRegionOrOfTheOwnBodyNeverMoves) {
  LowScene scene = walker();
  const std::size_t outside = scene.add(kAhead, 0.1, 0.1), own = scene.add(kAhead, 0.12, 0.1);
  const std::size_t foot = scene.add(kAhead, 0.14, 0.1);
  scene.sawBareGround();
  scene.inside[outside] = 0;
  scene.judged.is_solid[own] = 0;
  const std::vector<Proof> joined = scene.joined();
  EXPECT_EQ(joined[outside], Proof::kNone);
  EXPECT_EQ(joined[own], Proof::kNone);
  EXPECT_NE(joined[foot], Proof::kNone);
}

TEST(LowParts, NothingIsRememberedFromScanToScan) {
  LowScene first = walker(level, 3.0);
  first.add(kAhead, 3.2, 0.1);
  first.sawBareGround();
  LowScene second = walker();  // whoever walked at the first place is gone
  for (const double y : {0.1, 3.0, 3.2}) second.add(kAhead, y, 0.1);
  second.sawBareGround();
  LowParts parts(kReach, EvidenceConfig{});
  for (int k = 0; k < 2; ++k) {
    EXPECT_EQ(first.joinedBy(parts), first.joined());
    EXPECT_EQ(second.joinedBy(parts), second.joined());
  }
}

TEST(LowParts, WhatStandsFarFromAllThatMovesTakesNoRoom) {
  LowScene scene = walker();
  for (int i = 0; i < 5000; ++i)
    scene.add(-12.0 + 0.2 * (i % 60), -12.0 + 0.28 * (i / 60), 1.0);  // nothing moves behind
  LowParts parts(kReach, EvidenceConfig{});
  walker(level, 5.0).joinedBy(parts);  // right there, but that is over
  scene.joinedBy(parts);
  const double bytes = LowParts::bytesFor(kReach, static_cast<double>(scene.judged.points.size()));
  EXPECT_LT(static_cast<double>(parts.memoryBytes()), bytes + 10'000.0);
}

/// Things that move or stand, often side by side, with low echoes around them: on slopes and pavements, before the
/// sensor and at the edge of the square, as wide as a lorry or a leg.
class RandomScene {
 public:
  explicit RandomScene(unsigned seed) : random_(seed), scene_(randomSurface()) {
    scene_.judged.sensor.head<2>() = Eigen::Vector2f(real(-0.5, 0.5), real(-0.5, 0.5));
    for (int k = 0; k < 10; ++k) addPair();
    const std::size_t own = scene_.proofs.size();
    for (int k = 0; k < 3; ++k) addPair();
    scene_.judged.beside = scene_.proofs.size() - own;
    scene_.inside.resize(own);
    scene_.judged.is_solid.resize(own);
    scene_.findGround(real(0.0, 1.0));
    for (ClusterRole& role : scene_.judged.roles) role = chance(0.05) ? ClusterRole::kLoose : role;
    for (const double x : {-0.4, 0.1, 0.3}) lookFrom({x, -0.2 * x, kMount + 0.1 * x});
  }

  LowScene& scene() { return scene_; }

 private:
  float real(double low, double high) {
    return static_cast<float>(std::uniform_real_distribution<double>(low, high)(random_));
  }
  bool chance(double share) { return std::bernoulli_distribution(share)(random_); }

  Surface randomSurface() {
    const double x_slope = real(-0.05, 0.05), y_slope = real(-0.05, 0.05), kerb = real(-10.0, 10.0);
    return [=](double x, double y) { return x_slope * x + y_slope * y + (y > kerb ? 0.1 : 0.0); };
  }

  void addPair() {
    const double x = real(-kReach - 0.3, kReach + 0.3), y = real(-kReach - 0.3, kReach + 0.3);
    addThing(x, y, true);
    const double apart = real(0.2, 1.2), direction = real(-3.0, 3.0);
    addThing(x + apart * std::cos(direction), y + apart * std::sin(direction), chance(0.3));
  }

  void addThing(double x, double y, bool moves) {
    const Eigen::Vector2d ray = Eigen::Vector2d(x, y).normalized();
    const double width = moves && chance(0.15) ? real(2.0, 24.0) : 0.2;
    const auto echoes = static_cast<int>(20.0 + 10.0 * width);
    const std::size_t first = scene_.proofs.size();
    for (int i = 0; i < echoes; ++i) {
      const bool is_low = chance(0.6);
      const double along = real(-0.5, 0.5) * width, fray = is_low ? 0.6 : 0.15;
      const double at_x = x - along * ray.y() + real(-fray, fray), at_y = y + along * ray.x() + real(-fray, fray);
      const double height = is_low ? real(-0.4, 0.27) : real(0.25, 1.2);
      const bool is_proven = moves && chance(is_low ? 0.02 : 0.95);
      const auto proof = static_cast<Proof>(std::uniform_int_distribution<int>(1, kProofs - 1)(random_));
      const std::size_t echo = scene_.add(at_x, at_y, height, is_proven ? proof : Proof::kNone);
      if (chance(0.02)) scene_.judged.points[echo].setConstant(std::numeric_limits<float>::quiet_NaN());
      scene_.inside[echo] = chance(0.05) ? 0 : 1;
      scene_.judged.is_solid[echo] = chance(0.05) ? 0 : 1;
    }
    things_.push_back({first, chance(0.4), chance(0.4)});
  }

  /// A scan before: of each thing it saw through the place or a surface there, something before it, or nothing.
  void lookFrom(const Eigen::Vector3d& sensor) {
    const Eigen::Vector3f from = sensor.cast<float>();
    std::vector<Eigen::Vector3f> seen;
    for (std::size_t k = 0; k < things_.size(); ++k) {
      const Thing& thing = things_[k];
      const std::size_t last = k + 1 < things_.size() ? things_[k + 1].first : scene_.proofs.size();
      const float behind = thing.was_hidden ? -1.0F : (thing.has_come && chance(0.5) ? 0.4F : real(-0.35, 0.35));
      if (chance(0.3)) continue;
      for (std::size_t i = thing.first; i < last; ++i) {
        const Eigen::Vector3f& point = scene_.judged.points[i];
        seen.push_back(point + behind * (point - from).normalized());
      }
    }
    seen.erase(std::remove_if(seen.begin(), seen.end(), [](const auto& echo) { return !echo.allFinite(); }),
               seen.end());
    scene_.saw(seen, sensor);
  }

  struct Thing {
    std::size_t first;  ///< its first echo; those up to the next thing's are its own
    bool has_come, was_hidden;
  };

  std::mt19937 random_;
  LowScene scene_;
  std::vector<Thing> things_;
};

TEST(LowParts, AreThoseOfThePlainRule) {
  LowParts parts(kReach, EvidenceConfig{});
  std::array<int, oracle::kLowParts> counts{};
  for (unsigned seed = 1; seed <= 60; ++seed) {
    RandomScene random(seed);
    LowScene& scene = random.scene();
    const SightView before = scene.before();
    const oracle::LowParts rule(kReach, scene.judged, scene.inside, before, scene.ground, scene.proofs);
    const std::vector<Proof> joined = scene.joinedBy(parts);
    for (std::size_t i = 0; i < joined.size(); ++i) {
      Proof expected = scene.proofs[i];
      const bool is_own = i < scene.judged.own();
      const auto reason = is_own ? static_cast<std::size_t>(rule.judge(i, expected)) : oracle::kLowParts;
      ASSERT_EQ(joined[i], expected) << "seed " << seed << ", echo " << i << ", reason " << reason;
      if (is_own) ++counts[reason];
    }
  }
  for (std::size_t reason = 0; reason < counts.size(); ++reason) EXPECT_GT(counts[reason], 50) << "reason " << reason;
}

/// Echoes of a moving object in a scan.
struct Mover {
  std::vector<std::size_t> echoes;
  Eigen::Vector3f center = Eigen::Vector3f::Zero();
};

std::map<std::uint32_t, Mover> moversIn(const TrueScan& scan) {
  std::map<std::uint32_t, Mover> movers;
  for (std::size_t i = 0; i < scan.truth.size(); ++i) {
    const std::uint32_t kind = scan.truth[i] & 0xFFFF;
    if (kind >= 252 && kind <= 259) movers[scan.truth[i]].echoes.push_back(i);
  }
  for (auto& [label, mover] : movers) {
    for (const std::size_t i : mover.echoes) mover.center += scan.scan.echoes[i];
    mover.center /= static_cast<float>(mover.echoes.size());
  }
  return movers;
}

/// Mean height of the true ground around a place [m]; NaN where none is seen.
float groundAround(const TrueScan& scan, const Eigen::Vector3f& place) {
  constexpr std::array<std::uint32_t, 5> kGround{40, 44, 48, 49, 72};
  float sum = 0.0F, count = 0.0F;
  for (std::size_t i = 0; i < scan.truth.size(); ++i) {
    const bool is_ground = std::find(kGround.begin(), kGround.end(), scan.truth[i]) != kGround.end();
    if (!is_ground || (scan.scan.echoes[i] - place).head<2>().norm() > 2.0F) continue;
    sum += scan.scan.echoes[i].z();
    ++count;
  }
  return sum / count;
}

/// Of the echoes lower than the ground clearance, of moving objects of which most is labelled above it.
double labelledShareOfLowEchoes(const std::vector<TrueScan>& drive) {
  constexpr std::size_t kWarmUp = 5;
  const std::vector<EchoLabels> labels = labelsOf(Config(), drive);
  int labelled = 0, all = 0;
  for (std::size_t k = kWarmUp; k < drive.size(); ++k) {
    for (const auto& [label, mover] : moversIn(drive[k])) {
      const float ground = groundAround(drive[k], mover.center);
      std::array<int, 2> moving{}, echoes{};  // low ones, others
      for (const std::size_t i : mover.echoes) {
        const std::size_t part = drive[k].scan.echoes[i].z() - ground <= 0.25F ? 0 : 1;
        ++echoes[part];
        moving[part] += labels[k].dynamic[i];
      }
      if (2 * moving[1] <= echoes[1]) continue;
      labelled += moving[0];
      all += echoes[0];
    }
  }
  EXPECT_GT(all, 500) << "nothing to judge";
  return static_cast<double>(labelled) / all;
}

TEST(LowParts, FeetWheelsAndSillsAreLabelledWithWhatStandsOnThem) {
  // 0.79 in both; without the low parts 0.37 and 0.53.
  for (const auto& [scene, least] : {std::pair{"far_people", 0.65}, {"street", 0.7}}) {
    EXPECT_GT(labelledShareOfLowEchoes(simulatedDrive(scene, 64, 25)), least) << scene;
  }
}

}  // namespace
}  // namespace donex
