// Which places are new: against the plain rules on a room whose walls come and go, and case by case.
#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "core/evidence/newness_rig.h"
#include "support/newness_oracle.h"

namespace donex {
namespace {

using testing::gridOf;
using testing::RestlessRoom;
using testing::Rig;

constexpr std::size_t kPlaces = 16;
constexpr Place kSurelyCoarselyNew = both(Place::kSurelyNew, Place::kCoarselyNew);
constexpr Place kSurelyLingering = both(Place::kSurelyNew, Place::kLingering);

struct Case {
  unsigned switches;  ///< bits: free_evidence, careful_sight, birth_age, neighbourhood
  bool moves;
};

class AgainstThePlainRules : public ::testing::TestWithParam<Case> {
 protected:
  Config config() const {
    Config config = gridOf();
    config.evidence.free_evidence = (GetParam().switches & 1U) != 0;
    config.evidence.careful_sight = (GetParam().switches & 2U) != 0;
    config.evidence.birth_age = (GetParam().switches & 4U) != 0;
    config.evidence.neighbourhood = (GetParam().switches & 8U) != 0;
    config.evidence.birth_window = 0.9;
    return config;
  }

  template <class Newness, class Oracle>
  std::array<int, kPlaces> compare() {
    Rig<Newness> rig(config());
    Oracle oracle(config());
    RestlessRoom room(GetParam().switches + 100U, GetParam().moves);
    std::array<int, kPlaces> places{};
    int different = 0;
    for (int k = 0; k < 30 && different == 0; ++k) {
      const Scan scan = room.next();
      oracle.begin(scan);
      rig.process(scan, [&](const Eigen::Vector3f& in_window, const Eigen::Vector3f& point, Place place) {
        const Place expected = oracle.judge(in_window, point, rig.before);
        if (place != expected && different++ == 0) {
          ADD_FAILURE() << "scan " << k << " at " << in_window.transpose() << ": " << static_cast<int>(place)
                        << " instead of " << static_cast<int>(expected);
        }
        ++places[static_cast<std::size_t>(place)];
      });
    }
    return places;
  }
};

void expectAllKinds(const std::array<int, kPlaces>& places, const EvidenceConfig& config) {
  const auto count = [&](Place kind) {
    int all = 0;
    for (std::size_t place = 0; place < kPlaces; ++place) {
      const bool is_one = isNewPlace(kind) ? is(Place(place), kind) : Place(place) == kind;
      all += is_one ? places[place] : 0;
    }
    return all;
  };
  EXPECT_GT(count(Place::kUnobserved), 30);
  EXPECT_GT(count(Place::kSurelyNew), 30);
  EXPECT_GT(count(Place::kSettled), 30);
  // Without the neighbourhood only surfaces that earlier scans saw in the place itself are left.
  if (config.neighbourhood) {
    EXPECT_GT(count(Place::kAtSurface), 30);
  }
  if (config.birth_age) {
    EXPECT_GT(count(Place::kLingering), 10);
  }
}

TEST_P(AgainstThePlainRules, In3d) { expectAllKinds(compare<Newness3d, oracle::Newness3d>(), config().evidence); }
TEST_P(AgainstThePlainRules, In2d) { expectAllKinds(compare<Newness2d, oracle::Newness2d>(), config().evidence); }

std::vector<Case> cases() {
  std::vector<Case> all;
  for (unsigned switches = 0; switches < 16; ++switches) {
    for (const bool moves : {false, true}) all.push_back({switches, moves});
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Switches, AgainstThePlainRules, ::testing::ValuesIn(cases()));

/// A wall all around at 10 m, and, where `range` is given, something before it ahead. The first echo lies ahead.
Scan ahead(double stamp, double range = 10.0, const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity(),
           double beams_apart = 0.02) {
  Scan scan;
  scan.stamp = stamp;
  scan.odom_from_base = pose;
  for (int azimuth = 0; azimuth < 720; ++azimuth) {
    for (int beam = 0; beam < 5; ++beam) {
      const double angle = azimuth * M_PI / 360.0, slope = beams_apart * beam + 0.01;
      const bool is_ahead = azimuth < 20 || azimuth > 700;
      const Eigen::Vector3d direction = Eigen::Vector3d(std::cos(angle), std::sin(angle), slope).normalized();
      scan.echoes.push_back(((is_ahead ? range : 10.0) * direction).cast<float>());
    }
  }
  return scan;
}

/// The wall behind alone: what lies ahead is out of view.
Scan behind(double stamp) {
  Scan scan = ahead(stamp);
  const auto is_ahead = [](const Eigen::Vector3f& echo) { return echo.x() > 0.0F; };
  scan.echoes.erase(std::remove_if(scan.echoes.begin(), scan.echoes.end(), is_ahead), scan.echoes.end());
  return scan;
}

template <class Newness>
class Newnesses : public ::testing::Test {};
using Both = ::testing::Types<Newness3d, Newness2d>;
TYPED_TEST_SUITE(Newnesses, Both, );

TYPED_TEST(Newnesses, WhatComesIntoFreeSpaceIsNewUntilItsBirthWindowIsOverAndLingersMeanwhile) {
  Config config = gridOf(0.2);
  config.evidence.birth_window = 1.0;
  Rig<TypeParam> rig(config);
  for (int k = 0; k < 10; ++k) rig.first(ahead(0.125 * k));
  for (int k = 10; k <= 30; ++k) {
    const double age = 0.125 * (k - 10);
    const Place young = age <= 0.5 ? Place::kSurelyNew : kSurelyLingering;
    EXPECT_EQ(rig.first(ahead(0.125 * k, 6.0)), age <= 1.0 ? young : Place::kSettled) << "scan " << k;
  }
}

TYPED_TEST(Newnesses, BeamsFarApartHaveToSeeAPlaceFreeMoreOften) {
  const auto placeAfter = [](int scans, double beams_apart) {
    Rig<TypeParam> rig(gridOf(0.2));
    const Eigen::Isometry3d at_rest = Eigen::Isometry3d::Identity();
    for (int k = 0; k < scans; ++k) rig.first(ahead(0.1 * k, 10.0, at_rest, beams_apart));
    return rig.first(ahead(0.1 * scans, 8.0, at_rest, beams_apart));
  };
  EXPECT_EQ(placeAfter(3, 0.02), Place::kSurelyNew);
  EXPECT_EQ(placeAfter(3, 0.1), Place::kUnobserved) << "0.8 m apart there, half as sure";
  EXPECT_EQ(placeAfter(5, 0.1), kSurelyCoarselyNew);
}

TYPED_TEST(Newnesses, WhatComesOutOfViewLingersFromItsBirth) {
  for (int unseen = 0; unseen <= 6; ++unseen) {
    Rig<TypeParam> rig(gridOf(0.2));
    double stamp = 0.0;
    for (int k = 0; k < 4; ++k) rig.first(ahead(stamp += 0.125));
    for (int k = 0; k < unseen; ++k) rig.first(behind(stamp += 0.125));
    EXPECT_EQ(rig.first(ahead(stamp += 0.125, 6.0)), unseen >= 4 ? kSurelyLingering : Place::kSurelyNew) << unseen;
  }
}

TYPED_TEST(Newnesses, WhatComesOutOfAShadowDoesNotLinger) {
  Rig<TypeParam> rig(gridOf(0.2));
  double stamp = 0.0;
  for (int k = 0; k < 10; ++k) rig.first(ahead(stamp += 0.125));
  for (int k = 0; k < 6; ++k) rig.first(ahead(stamp += 0.125, 4.0));
  EXPECT_TRUE(isNewPlace(rig.first(ahead(stamp += 0.125, 8.0))));
  EXPECT_FALSE(is(rig.first(ahead(stamp += 0.125, 8.0)), Place::kLingering));
}

TYPED_TEST(Newnesses, WithoutAnAgeOnlyTheScanOfBirthIsNew) {
  Config config = gridOf(0.2);
  config.evidence.birth_age = false;
  Rig<TypeParam> rig(config);
  for (int k = 0; k < 10; ++k) rig.first(ahead(0.125 * k));
  EXPECT_EQ(rig.first(ahead(2.0, 6.0)), Place::kSurelyNew);
  EXPECT_EQ(rig.first(ahead(2.125, 6.0)), Place::kSettled);
}

TYPED_TEST(Newnesses, NeverHitIsNewOnlyWithoutFreeEvidence) {
  for (const bool free_evidence : {true, false}) {
    Config config = gridOf(0.2);
    config.evidence.free_evidence = free_evidence;
    Rig<TypeParam> rig(config);
    EXPECT_EQ(rig.first(ahead(0.0, 6.0)), Place::kUnobserved) << "nothing is new in the first scan";
    // Behind what was seen: hidden before, never seen free.
    EXPECT_EQ(rig.first(ahead(0.1, 9.0)), free_evidence ? Place::kUnobserved : Place::kSurelyNew);
  }
}

TYPED_TEST(Newnesses, UnobservedSettlesAfterHalfASecond) {
  Rig<TypeParam> rig(gridOf(0.2));
  for (int k = 0; k <= 8; ++k) {
    EXPECT_EQ(rig.first(ahead(0.125 * k)), k <= 4 ? Place::kUnobserved : Place::kSettled) << "scan " << k;
  }
}

TYPED_TEST(Newnesses, ASettledPlaceIsForgottenOnlyByEnoughScansThatSeeThrough) {
  for (int through = 0; through <= 6; ++through) {
    Config config = gridOf(0.2);
    config.evidence.neighbourhood = false;  // what stood beside it is settled as well
    Rig<TypeParam> rig(config);
    double stamp = 0.0;
    for (int k = 0; k < 10; ++k) rig.first(ahead(stamp += 0.1, 6.0));
    for (int k = 0; k < through; ++k) rig.first(ahead(stamp += 0.1, 10.0));
    const Place expected = through >= config.evidence.settled_free_scans ? Place::kSurelyNew : Place::kSettled;
    EXPECT_EQ(rig.first(ahead(stamp += 0.1, 6.0)), expected) << through << " scans saw through";
  }
}

TYPED_TEST(Newnesses, AShadowForgetsNothing) {
  Rig<TypeParam> rig(gridOf(0.2));
  double stamp = 0.0;
  for (int k = 0; k < 10; ++k) rig.first(ahead(stamp += 0.1, 8.0));
  for (int k = 0; k < 10; ++k) rig.first(ahead(stamp += 0.1, 4.0));
  EXPECT_EQ(rig.first(ahead(stamp += 0.1, 8.0)), Place::kSettled);
}

TYPED_TEST(Newnesses, TheFlickerOfASurfaceIsNotNew) {
  for (const bool neighbourhood : {true, false}) {
    Config config = gridOf(0.2);
    config.evidence.neighbourhood = neighbourhood;
    config.evidence.sight_margin = 0.02;  // so that the place before the wall is seen free at all
    Rig<TypeParam> rig(config);
    double stamp = 0.0;
    for (int k = 0; k < 10; ++k) rig.first(ahead(stamp += 0.1, 10.05));
    for (int k = 0; k < 3; ++k) {  // and it stays what it was
      EXPECT_EQ(rig.first(ahead(stamp += 0.1, 9.95)), neighbourhood ? Place::kAtSurface : Place::kSurelyNew) << k;
    }
  }
}

TYPED_TEST(Newnesses, WhatLeavesTheWindowIsForgotten) {
  const Eigen::Isometry3d far_away(Eigen::Translation3d(200.0, 0.0, 0.0));
  for (const bool leaves : {true, false}) {
    Rig<TypeParam> rig(gridOf(0.2));
    double stamp = 0.0;
    for (int k = 0; k < 10; ++k) rig.first(ahead(stamp += 0.1));
    rig.first(ahead(stamp += 0.1, 10.0, leaves ? far_away : Eigen::Isometry3d::Identity()));
    EXPECT_EQ(rig.first(ahead(stamp += 0.1)), leaves ? Place::kAtSurface : Place::kSettled)
        << "the grid has forgotten it, earlier scans saw a surface there";
  }
}

TYPED_TEST(Newnesses, ResetForgetsEverything) {
  Rig<TypeParam> rig(gridOf(0.2));
  for (int k = 0; k < 10; ++k) rig.first(ahead(0.1 * k));
  rig.newness.reset();
  rig.clock.reset();
  rig.history.reset();
  EXPECT_EQ(rig.first(ahead(0.0)), Place::kUnobserved);
}

TYPED_TEST(Newnesses, MemoryIsBoundedByTheRegion) {
  Rig<TypeParam> rig(gridOf(0.5));
  std::size_t most_in_the_first_part = 0;
  for (int k = 0; k < 300; ++k) {
    rig.first(ahead(0.1 * k, 6.0, Eigen::Isometry3d(Eigen::Translation3d(0.9 * k, 0.3 * k, 0.0))));
    if (k < 100) most_in_the_first_part = std::max(most_in_the_first_part, rig.newness.memoryBytes());
  }
  EXPECT_LE(rig.newness.memoryBytes(), 2 * most_in_the_first_part);
}

TEST(ScanClock, TellsStampsAsFarAsItRemembers) {
  ScanClock clock(1.0);
  for (int k = 1; k <= 1000; ++k) clock.begin(0.5 * k);
  EXPECT_EQ(clock.scan(), 1000U);
  EXPECT_EQ(clock.stampOf(1000), 500.0);
  EXPECT_EQ(clock.stampOf(900), 450.0);
  EXPECT_LT(clock.stampOf(1), -1e300);
  EXPECT_TRUE(clock.isYoung(998, true));
  EXPECT_FALSE(clock.isYoung(997, true));
  EXPECT_TRUE(clock.isYoung(999, false)) << "found half a second ago";
  EXPECT_FALSE(clock.isYoung(998, false));
}

}  // namespace
}  // namespace donex
