#include <gtest/gtest.h>

#include "core/pi.h"
#include "simulation/path.h"
#include "simulation/random.h"
#include "simulation/speed_profile.h"

namespace donex::simulation {
namespace {

Path randomPath(Random& random) {
  Path path({random.uniform(-50.0, 50.0), random.uniform(-50.0, 50.0)}, random.uniform(-kPi, kPi));
  for (int i = 0; i < 5; ++i) {
    path.line(random.uniform(5.0, 40.0));
    const double radius = random.uniform(15.0, 40.0);
    path.arc(radius, random.uniform(-0.4, 0.4));
  }
  return path;
}

TEST(Path, IsSmoothAndItsLengthIsItsLength) {
  constexpr double kStep = 0.01;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    const Path path = randomPath(random);
    for (double s = -3.0; s < path.length() + 3.0; s += 0.37) {
      const PathPoint here = path.at(s);
      const Eigen::Vector2d step = path.at(s + kStep).position - here.position;
      EXPECT_NEAR(step.norm(), kStep, 1e-6);
      EXPECT_NEAR((step / kStep - here.forward()).norm(), 0.0, 1e-3);
    }
  }
}

TEST(Path, FindsAgainWhatLiesBesideIt) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    const Path path = randomPath(random);
    for (int i = 0; i < 100; ++i) {
      const double s = random.uniform(0.0, path.length());
      const double lateral = random.uniform(-3.0, 3.0);
      const Path::Projection found = path.project(path.at(s, lateral).position);
      // Another part of the path may be nearer, never further.
      EXPECT_LE(found.distance, std::abs(lateral) + 1e-9);
      if (found.distance > std::abs(lateral) - 1e-9) {
        EXPECT_NEAR(found.s, s, 1e-6);
        EXPECT_NEAR(found.lateral, lateral, 1e-9);
      }
    }
  }
}

TEST(Path, ProjectionIsTheNearestOfManySamples) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Random random(seed);
    const Path path = randomPath(random);
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector2d point(random.uniform(-100.0, 100.0), random.uniform(-100.0, 100.0));
      double nearest = 1e9;
      for (double s = 0.0; s <= path.length(); s += 0.05) {
        nearest = std::min(nearest, (path.at(s).position - point).norm());
      }
      EXPECT_NEAR(path.project(point).distance, nearest, 0.03);
    }
  }
}

TEST(Path, CircuitEndsWhereItBegan) {
  Path circuit({3.0, 4.0}, 0.7);
  for (int i = 0; i < 2; ++i) circuit.line(50.0).arc(12.0, kPi);
  circuit.wrap();
  EXPECT_NEAR((circuit.at(circuit.length() - 1e-9).position - circuit.at(0.0).position).norm(), 0.0, 1e-6);
  EXPECT_NEAR((circuit.at(17.0 - 3.0 * circuit.length(), 1.5).position - circuit.at(17.0, 1.5).position).norm(), 0.0,
              1e-9);
}

void expectIntegral(const SpeedProfile& profile, double from, double to) {
  constexpr int kSteps = 20000;
  double sum = 0.0;
  const double step = (to - from) / kSteps;
  for (int i = 0; i < kSteps; ++i) sum += step * profile.speed(from + (i + 0.5) * step);
  EXPECT_NEAR(profile.distance(to) - profile.distance(from), sum, 1e-3) << from << " to " << to;
}

TEST(SpeedProfile, DistanceIsTheIntegralOfTheSpeed) {
  const std::vector<SpeedProfile::Knot> knots{{1.0, 7.0}, {4.0, 7.0}, {6.5, 0.0}, {9.0, 0.0}, {13.0, 7.0}};
  for (const bool repeated : {false, true}) {
    SpeedProfile profile(knots);
    if (repeated) profile.repeat();
    EXPECT_EQ(profile.distance(1.0), 0.0);
    expectIntegral(profile, -20.0, 1.0);
    expectIntegral(profile, 1.0, 60.0);
    expectIntegral(profile, 8.2, 33.3);
  }
  EXPECT_NEAR(SpeedProfile(3.0).distance(-2.0), -6.0, 1e-12);
}

}  // namespace
}  // namespace donex::simulation
