// Second returns are found by their direction, as a comparison of all echoes with all others finds them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/sight/second_returns.h"

namespace donex {
namespace {

using Marks = std::vector<std::uint8_t>;

/// Rays of 32 beams, one every half degree; a share of them comes back twice, the farther echo anywhere in the cloud.
class Sensor {
 public:
  std::vector<Eigen::Vector3f> scan(double share, const Eigen::Vector3f& place = Eigen::Vector3f::Zero()) {
    std::uniform_real_distribution<float> ranges(2.0F, 60.0F), behind(0.3F, 8.0F);
    std::bernoulli_distribution is_twice(share);
    std::vector<Eigen::Vector3f> echoes;
    for (int beam = 0; beam < 32; ++beam) {
      for (int column = 0; column < 720; ++column) {
        const Eigen::Vector3f direction = directionOf(beam, column);
        const float range = ranges(random_);
        echoes.emplace_back(place + range * direction);
        if (is_twice(random_)) echoes.emplace_back(place + (range + behind(random_)) * direction);
      }
    }
    std::shuffle(echoes.begin(), echoes.end(), random_);
    return echoes;
  }

 private:
  static Eigen::Vector3f directionOf(int beam, int column) {
    const float elevation = -0.3F + 0.02F * static_cast<float>(beam);
    const float azimuth = static_cast<float>(column) * static_cast<float>(M_PI) / 360.0F;
    return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
  }

  std::mt19937 random_{5};
};

Marks byComparison(const std::vector<Eigen::Vector3f>& echoes) {
  const SecondReturns::Options options;
  Marks marks(echoes.size(), 0);
  std::vector<Eigen::Vector3f> directions;
  for (const Eigen::Vector3f& echo : echoes) directions.emplace_back(echo / echo.norm());
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    for (std::size_t k = 0; k < echoes.size(); ++k) {
      const bool is_same = (directions[i] - directions[k]).norm() <= options.same_direction;
      if (is_same && echoes[i].norm() - echoes[k].norm() > options.least_behind) marks[i] = 1;
    }
  }
  return marks;
}

std::size_t countOf(const Marks& marks) { return static_cast<std::size_t>(std::count(marks.begin(), marks.end(), 1)); }

TEST(SecondReturns, AreTheFartherEchoesOfOneDirection) {
  Sensor sensor;
  SecondReturns returns;
  for (int i = 0; i < 2; ++i) {
    const auto echoes = sensor.scan(0.2);
    const Marks& found = returns.find(echoes);
    EXPECT_EQ(found, byComparison(echoes));
    EXPECT_EQ(countOf(found), echoes.size() - 32 * 720);
  }
}

TEST(SecondReturns, AreFoundAmongEchoesThatAreNoNumbers) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kFar = std::numeric_limits<float>::infinity();
  auto echoes = Sensor().scan(0.2);
  SecondReturns returns;
  const Marks before = returns.find(echoes);
  const std::size_t count = echoes.size();
  for (const Eigen::Vector3f& nothing :
       {Eigen::Vector3f(kNan, 1.0F, 0.0F), Eigen::Vector3f(kFar, kFar, 0.0F), Eigen::Vector3f(0.0F, 0.0F, 0.0F)}) {
    echoes.insert(echoes.end(), 500, nothing);
  }
  const Marks& found = returns.find(echoes);
  ASSERT_EQ(found.size(), echoes.size());
  EXPECT_TRUE(std::equal(before.begin(), before.end(), found.begin()));
  EXPECT_EQ(countOf(found), countOf(before));
  EXPECT_EQ(count + 1500, echoes.size());
}

TEST(SecondReturns, NoneWhereABeamComesBackOnce) {
  Sensor sensor;
  SecondReturns returns;
  for (int i = 0; i < 50; ++i) EXPECT_TRUE(returns.find(sensor.scan(0.0)).empty()) << i;
  EXPECT_TRUE(returns.find({}).empty());
}

TEST(SecondReturns, AreNoticedLaterAndForgottenLater) {
  const auto single = Sensor().scan(0.0), dual = Sensor().scan(0.2);
  const SecondReturns::Options options;
  SecondReturns returns;
  for (int i = 0; i < 10; ++i) returns.find(single);
  int unnoticed = 0;
  while (returns.find(dual).empty() && unnoticed < 100) ++unnoticed;
  EXPECT_LT(unnoticed, options.rest);
  int searched = 0;
  while (!returns.find(single).empty() && searched < 100) ++searched;
  EXPECT_EQ(searched, options.rest);
  returns.reset();
  EXPECT_FALSE(returns.find(dual).empty()) << "as at the beginning";
}

TEST(SecondReturns, SmallCloudsAreAskedTogether) {
  const auto dual = Sensor().scan(0.2);
  std::vector<Eigen::Vector3f> beside;  // pairs of a narrow sensor, side by side
  for (const Eigen::Vector3f& echo : dual) {
    if (std::abs(std::atan2(echo.y(), echo.x())) < 0.02F) beside.push_back(echo);
  }
  ASSERT_LT(beside.size(), 250U);
  SecondReturns returns;
  int clouds = 1;
  while (returns.find(beside).empty() && clouds < 100) ++clouds;
  EXPECT_LE(clouds, 20);
}

TEST(SecondReturns, AreSeenFromWhereTheSensorIs) {
  const Eigen::Vector3f place(1.1F, -0.3F, 1.8F);
  const auto echoes = Sensor().scan(0.2, place);
  SecondReturns from_sensor, from_origin;
  EXPECT_EQ(countOf(from_sensor.find(echoes, place)), echoes.size() - 32 * 720);
  EXPECT_TRUE(from_origin.find(echoes).empty());
}

TEST(SecondReturns, SurviveCoordinatesInWholeMillimetres) {
  auto echoes = Sensor().scan(0.2);
  for (Eigen::Vector3f& echo : echoes) echo = (echo.array() * 1000.0F).round().matrix() / 1000.0F;
  SecondReturns returns;
  const auto pairs = static_cast<double>(echoes.size() - 32 * 720);
  EXPECT_GT(static_cast<double>(countOf(returns.find(echoes))), 0.95 * pairs);
}

}  // namespace
}  // namespace donex
