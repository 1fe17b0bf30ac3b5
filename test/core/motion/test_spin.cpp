// Where a spinning sensor began, and which way it turned, from the order of a cloud's echoes; and its echoes' times.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "core/motion/azimuth_times.h"
#include "core/pi.h"

namespace donex {
namespace {

constexpr std::size_t kFirings = 900, kBeams = 16;
constexpr double kPeriod = 0.1;  // of a turn [s]

struct Turn {
  double start = 0.5;       // [turns]
  double turned = 1.0;      // [turns]
  double direction = -1.0;  // clockwise
  double lost = 0.2;        // of the beams, without an echo
};

enum class Arranged { kByFiring, kInRows, kByRing, kNot };

/// What a sensor among scattered things sees, and how far it had turned.
struct Cloud {
  std::vector<Eigen::Vector3f> echoes;
  std::vector<double> turns;
  std::size_t columns = 0;
};

Cloud cloudOf(const Turn& turn, Arranged arranged) {
  std::mt19937 random(7);
  Cloud cloud;
  const bool by_firing = arranged == Arranged::kByFiring;
  for (std::size_t i = 0; i < kFirings * kBeams; ++i) {
    const std::size_t firing = by_firing ? i / kBeams : i % kFirings, beam = by_firing ? i % kBeams : i / kFirings;
    const double turns = turn.turned * (static_cast<double>(firing) + 0.5) / kFirings;
    const double azimuth = 2.0 * kPi * (turn.start + turn.direction * turns);
    const double range = 5.0 + 20.0 * std::uniform_real_distribution<double>()(random);
    const double slope = 0.03 * (static_cast<double>(beam) - 8.0);
    const bool is_lost = std::uniform_real_distribution<double>()(random) < turn.lost;
    Eigen::Vector3f echo = (range * Eigen::Vector3d(std::cos(azimuth), std::sin(azimuth), slope)).cast<float>();
    if (is_lost && arranged != Arranged::kInRows) continue;
    if (is_lost) echo.setConstant(std::numeric_limits<float>::quiet_NaN());
    cloud.echoes.push_back(echo);
    cloud.turns.push_back(turns);
  }
  if (arranged == Arranged::kNot) std::shuffle(cloud.echoes.begin(), cloud.echoes.end(), random);
  cloud.columns = arranged == Arranged::kInRows ? kFirings : cloud.echoes.size();
  return cloud;
}

class SpinOf : public ::testing::TestWithParam<std::tuple<Arranged, double, double>> {};

TEST_P(SpinOf, AnyOrderAndBeginIsMeasured) {
  const auto [arranged, start, direction] = GetParam();
  const Cloud cloud = cloudOf({start, 1.0, direction}, arranged);
  Spin spin;
  ASSERT_TRUE(spin.look(cloud.echoes, cloud.columns));
  EXPECT_EQ(spin.isClockwise(), direction < 0.0);
  EXPECT_NEAR(std::remainder(static_cast<double>(spin.start()) - start, 1.0), 0.0, 0.005);
  EXPECT_NEAR(spin.turned(), 1.0, 0.01);
  std::vector<float> turns;
  spin.turnsOf(cloud.echoes, turns);
  ASSERT_EQ(turns.size(), cloud.echoes.size());
  std::size_t far_off = 0;  // where rings begin and end, a noisy begin takes one for the other
  for (std::size_t i = 0; i < turns.size(); ++i) {
    if (!cloud.echoes[i].allFinite()) continue;
    far_off += std::abs(static_cast<double>(turns[i]) - cloud.turns[i]) > 0.01 ? 1U : 0U;
  }
  EXPECT_LE(far_off, cloud.echoes.size() / 100);
}

INSTANTIATE_TEST_SUITE_P(OfTurns, SpinOf,
                         ::testing::Combine(::testing::Values(Arranged::kByFiring, Arranged::kInRows,
                                                              Arranged::kByRing),
                                            ::testing::Values(0.5, 0.0, -0.31), ::testing::Values(-1.0, 1.0)));

TEST(Spin, HasATimeForWhatHasNoDirection) {
  Cloud cloud = cloudOf({}, Arranged::kByRing);
  for (std::size_t i = 0; i < cloud.echoes.size(); i += 7) {
    cloud.echoes[i].setConstant(i % 2 == 0 ? std::numeric_limits<float>::quiet_NaN() : 0.0F);
  }
  Spin spin;
  ASSERT_TRUE(spin.look(cloud.echoes, cloud.columns));
  std::vector<float> turns;
  spin.turnsOf(cloud.echoes, turns);
  for (const float turned : turns) ASSERT_TRUE(turned >= 0.0F && turned <= 1.0F) << turned;
}

TEST(Spin, IsNotTakenFromWhatIsInNoOrder) {
  Spin spin;
  const Cloud shuffled = cloudOf({}, Arranged::kNot);
  EXPECT_FALSE(spin.look(shuffled.echoes, shuffled.columns));
  const Cloud part = cloudOf({0.2, 0.25, 1.0}, Arranged::kByFiring);
  EXPECT_FALSE(spin.look(part.echoes, part.columns)) << "a quarter of a turn";
  std::vector<Eigen::Vector3f> echoes;
  EXPECT_FALSE(spin.look(echoes, 0));
  echoes.assign(1, {1.0F, 0.0F, 0.0F});
  EXPECT_FALSE(spin.look(echoes, 1));
  echoes.assign(5000, {1.0F, 0.0F, 0.0F});
  EXPECT_FALSE(spin.look(echoes, 5000)) << "all at one place";
  echoes.assign(5000, Eigen::Vector3f::Zero());
  EXPECT_FALSE(spin.look(echoes, 100));
  echoes.assign(5000, Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
  EXPECT_FALSE(spin.look(echoes, 100));
  echoes.assign(5000, Eigen::Vector3f::Constant(std::numeric_limits<float>::infinity()));
  EXPECT_FALSE(spin.look(echoes, 100));
}

/// The last echo's time, of the third of three clouds.
double lastTimeOf(const Turn& turn, double advance, double interval) {
  AzimuthTimes azimuth_times;
  std::vector<float> times;
  for (int k = 0; k < 3; ++k) {
    Turn next = turn;
    next.start += turn.direction * advance * k;
    const Cloud cloud = cloudOf(next, Arranged::kByFiring);
    const bool is_told = azimuth_times.read(10.0 + interval * k, cloud.echoes, cloud.columns, interval, times);
    EXPECT_EQ(is_told, k > 0 || turn.turned > 0.9) << k;
  }
  return times.empty() ? std::nan("") : static_cast<double>(times.back());
}

TEST(AzimuthTimes, FollowFromHowFarTheSensorTurnsFromCloudToCloud) {
  EXPECT_NEAR(lastTimeOf({0.5, 1.0, -1.0}, 0.0, kPeriod), kPeriod, 1e-3) << "whole turns";
  EXPECT_NEAR(lastTimeOf({0.5, 1.01, 1.0}, 1.01, 1.01 * kPeriod), 1.01 * kPeriod, 1e-3) << "a little more";
  EXPECT_NEAR(lastTimeOf({0.1, 0.667, -1.0}, 0.667, 0.0667), 0.0667, 1e-3) << "two thirds of a turn";
  EXPECT_NEAR(lastTimeOf({0.1, 0.6, 1.0}, 0.0, kPeriod), 0.6 * kPeriod, 1e-3) << "cut to what lies ahead";
}

TEST(AzimuthTimes, AreNoneWhereCloudsComeTooSeldom) {
  AzimuthTimes azimuth_times;
  const Cloud cloud = cloudOf({}, Arranged::kByFiring);
  std::vector<float> times;
  EXPECT_FALSE(azimuth_times.read(10.0, cloud.echoes, cloud.columns, 5.0, times));
  EXPECT_TRUE(times.empty());
}

}  // namespace
}  // namespace donex
