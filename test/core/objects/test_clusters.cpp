// Connected echoes: against brute force over all pairs of cells, and case by case.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "core/objects/clusters.h"

namespace donex {
namespace {

struct Echoes {
  Eigen::Vector3f sensor = Eigen::Vector3f::Zero();
  std::vector<Eigen::Vector3f> points;
  std::vector<float> heights;
  std::vector<ClusterRole> roles;

  void add(float x, float y, float height, ClusterRole how = ClusterRole::kConnects) {
    points.emplace_back(sensor.x() + x, sensor.y() + y, height - 1.5F);  // the ground lies below the sensor
    heights.push_back(height);
    roles.push_back(how);
  }
};

std::vector<int> clustersOf(const Echoes& echoes, double reach, const Clusters::Options& options) {
  Clusters clusters(reach, options);
  clusters.connect(echoes.sensor, echoes.points, echoes.heights, echoes.roles);
  std::vector<int> of;
  for (std::size_t i = 0; i < echoes.points.size(); ++i) of.push_back(clusters.of(i));
  return of;
}

/// The rule, pair by pair: cells touch within the reach of the lower one, of either on one level.
class BruteForce {
 public:
  BruteForce(const Echoes& echoes, double reach, const Clusters::Options& options)
      : options_(options), edge_(static_cast<int>(std::ceil(reach / options.cell))) {
    std::vector<Cell> cell_of(echoes.points.size());
    std::vector<bool> in(echoes.points.size(), false);
    std::map<Cell, int> label;
    for (std::size_t i = 0; i < cell_of.size(); ++i) {
      cell_of[i] = cellAt(echoes, i);
      in[i] = echoes.roles[i] != ClusterRole::kNone && echoes.heights[i] >= 0.0F &&
              echoes.heights[i] <= static_cast<float>(options.height) && std::abs(cell_of[i][0]) <= edge_ &&
              std::abs(cell_of[i][1]) <= edge_;
      if (in[i] && echoes.roles[i] == ClusterRole::kConnects) label.emplace(cell_of[i], static_cast<int>(label.size()));
    }
    spread(label);
    std::map<int, int> number;
    for (std::size_t i = 0; i < cell_of.size(); ++i) {
      Cell cell = cell_of[i];
      if (echoes.roles[i] == ClusterRole::kFollows) cell[2] = label.count({cell[0], cell[1], 0}) != 0 ? 0 : 1;
      const auto found = label.find(cell);
      const bool belongs = in[i] && found != label.end();
      of_.push_back(belongs ? number.emplace(found->second, static_cast<int>(number.size())).first->second
                            : Clusters::kNone);
    }
    count_ = static_cast<int>(number.size());
  }

  const std::vector<int>& of() const { return of_; }
  int count() const { return count_; }

 private:
  using Cell = std::array<int, 3>;

  Cell cellAt(const Echoes& echoes, std::size_t i) const {
    const auto per_cell = static_cast<float>(1.0 / options_.cell);
    return {static_cast<int>(std::floor((echoes.points[i].x() - echoes.sensor.x()) * per_cell)),
            static_cast<int>(std::floor((echoes.points[i].y() - echoes.sensor.y()) * per_cell)),
            static_cast<int>(std::floor(echoes.heights[i] * per_cell))};
  }

  bool touchFrom(const Cell& lower, const Cell& upper) const {
    const double away = std::hypot(lower[0], lower[1]);
    const int across = std::max(1, static_cast<int>(std::ceil(away * options_.across_angle)));
    const int up = std::max(1, static_cast<int>(std::ceil(away * options_.up_angle)));
    return upper[2] >= lower[2] && upper[2] - lower[2] <= up && std::abs(upper[0] - lower[0]) <= across &&
           std::abs(upper[1] - lower[1]) <= across;
  }

  void spread(std::map<Cell, int>& label) const {
    for (bool changed = true; changed;) {
      changed = false;
      for (auto& [a, label_a] : label) {
        for (auto& [b, label_b] : label) {
          if (label_a == label_b || !(touchFrom(a, b) || touchFrom(b, a))) continue;
          label_a = label_b = std::min(label_a, label_b);
          changed = true;
        }
      }
    }
  }

  Clusters::Options options_;
  int edge_;
  std::vector<int> of_;
  int count_ = 0;
};

TEST(Clusters, ConnectWhatBruteForceConnects) {
  std::mt19937 random(3);
  const auto draw = [&](double low, double high) {
    return static_cast<float>(std::uniform_real_distribution<double>(low, high)(random));
  };
  constexpr std::array<ClusterRole, 4> kStandings{ClusterRole::kConnects, ClusterRole::kConnects, ClusterRole::kFollows,
                                                  ClusterRole::kConnects};
  int clusters_in_all = 0, echoes_in_all = 0;
  for (int round = 0; round < 60; ++round) {
    const double reach = round % 3 == 0 ? 8.0 : 40.0;
    // Wide angles, so that the reach grows to several cells within the square.
    const Clusters::Options options{round % 2 == 0 ? 0.3 : 0.5, 2.5, 0.01 * (round % 5), 0.015 * (round % 4)};
    Echoes echoes;
    echoes.sensor = {draw(-50, 50), draw(-50, 50), 0.0F};
    const double spread = round % 3 == 0 ? 10.0 : 45.0;
    for (int i = 0; i < 60; ++i) {
      const float x = draw(-spread, spread), y = draw(-spread, spread), height = draw(0.0, 2.6);
      for (int k = 0; k < 4; ++k) {
        const ClusterRole roles = i % 10 == 0 ? ClusterRole::kNone : kStandings[static_cast<std::size_t>(k)];
        echoes.add(x + draw(-0.6, 0.6), y + draw(-0.6, 0.6), height + draw(-0.4, 0.4), roles);
      }
    }
    Clusters clusters(reach, options);
    clusters.connect(echoes.sensor, echoes.points, echoes.heights, echoes.roles);
    const BruteForce expected(echoes, reach, options);
    ASSERT_EQ(clusters.count(), expected.count()) << "round " << round;
    for (std::size_t i = 0; i < echoes.points.size(); ++i) {
      ASSERT_EQ(clusters.of(i), expected.of()[i]) << "round " << round << " echo " << i;
      echoes_in_all += clusters.of(i) != Clusters::kNone ? 1 : 0;
    }
    clusters_in_all += clusters.count();
  }
  EXPECT_GT(clusters_in_all, 500);
  EXPECT_GT(4 * echoes_in_all, 5 * clusters_in_all) << "too few of them connected";
}

const Clusters::Options kOptions{0.3, 4.5, 0.01, 0.015};

TEST(Clusters, ThreadsChangeNothing) {
  constexpr double kReach = 40.0;
  std::mt19937 random(4);
  std::uniform_real_distribution<float> across(-40.0F, 40.0F), up(0.2F, 4.0F);
  const Workers workers(3);
  int clusters_in_all = 0;
  for (const int count : {3000, 20000, 60000}) {  // from many clusters to one that nearly all belong to
    Echoes echoes;
    for (int i = 0; i < count; ++i) {
      echoes.add(across(random), across(random), up(random),
                 i % 5 == 0 ? ClusterRole::kFollows : ClusterRole::kConnects);
    }
    const std::vector<int> expected = clustersOf(echoes, kReach, kOptions);
    Clusters clusters(kReach, kOptions);
    for (int round = 0; round < 5; ++round) {
      clusters.connect(echoes.sensor, echoes.points, echoes.heights, echoes.roles, 0.0, workers);
      for (std::size_t i = 0; i < expected.size(); ++i) ASSERT_EQ(clusters.of(i), expected[i]) << "echo " << i;
    }
    clusters_in_all += clusters.count();
  }
  EXPECT_GT(clusters_in_all, 1000);
}

TEST(Clusters, NumbersFollowTheFirstEchoes) {
  Echoes echoes;
  for (const float x : {9.0F, 3.0F, 9.1F, -5.0F, 3.1F, 9.2F}) echoes.add(x, 2.0F, 1.0F);
  EXPECT_EQ(clustersOf(echoes, 20.0, kOptions), (std::vector<int>{0, 1, 0, 2, 1, 0}));
}

TEST(Clusters, AChainIsOneHoweverItIsOrdered) {
  Echoes echoes;
  for (const int i : {0, 7, 3, 1, 9, 5, 2, 8, 4, 6}) echoes.add(0.3F * static_cast<float>(i) + 0.15F, 4.0F, 1.0F);
  EXPECT_EQ(clustersOf(echoes, 20.0, kOptions), std::vector<int>(10, 0));
}

TEST(Clusters, TheReachGrowsWithTheDistance) {
  const auto connected = [](float x, float apart) {
    Echoes echoes;
    echoes.add(x, 0.1F, 1.0F);
    echoes.add(x, 0.1F + apart, 1.0F);
    return clustersOf(echoes, 100.0, kOptions)[1] == 0;
  };
  EXPECT_FALSE(connected(5.05F, 0.9F));
  EXPECT_TRUE(connected(80.05F, 0.9F)) << "a beam apart there";
  EXPECT_FALSE(connected(80.05F, 2.0F));
}

TEST(Clusters, OnesAboveTheOtherTouchVertically) {
  const auto connected = [](float x, float apart) {
    Echoes echoes;
    echoes.add(x, 0.1F, 0.5F);
    echoes.add(x, 0.1F, 0.5F + apart);
    return clustersOf(echoes, 100.0, kOptions)[1] == 0;
  };
  EXPECT_TRUE(connected(5.05F, 0.35F));
  EXPECT_FALSE(connected(5.05F, 0.95F));
  EXPECT_TRUE(connected(60.05F, 0.95F));
}

TEST(Clusters, BeamsFarApartTouchVertically) {
  constexpr double kBeams = 0.036;
  Echoes echoes;
  for (const float height : {0.4F, 1.1F}) echoes.add(20.0F, 0.0F, height);  // a beam apart
  echoes.add(20.0F, 0.0F, 3.0F);                                            // two and a half
  Clusters clusters(40.0, kOptions);
  const auto connected = [&](double beams_apart) {
    clusters.connect(echoes.sensor, echoes.points, echoes.heights, echoes.roles, beams_apart);
    return clusters.count();
  };
  EXPECT_EQ(connected(0.0), 3);
  EXPECT_EQ(connected(kBeams), 2);
  EXPECT_EQ(connected(0.005), 3) << "beams close together never connect less";
  Clusters::Options wide = kOptions;
  wide.up_angle = kOptions.up_beams * kBeams;
  connected(kBeams);
  const std::vector<int> expected = clustersOf(echoes, 40.0, wide);
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(clusters.of(i), expected[i]);
}

TEST(Clusters, TheSkirtHangsOnWhatStandsAboveItAndConnectsNothing) {
  Echoes echoes;
  echoes.add(5.0F, 0.1F, 0.4F);  // two objects,
  echoes.add(6.2F, 0.1F, 0.4F);
  for (int i = 0; i <= 8; ++i) echoes.add(5.0F + 0.15F * static_cast<float>(i), 0.1F, 0.2F, ClusterRole::kFollows);
  const std::vector<int> of = clustersOf(echoes, 20.0, kOptions);
  EXPECT_EQ(of[0], 0);
  EXPECT_EQ(of[1], 1) << "joined by the ground between them";
  EXPECT_EQ(of[2], 0) << "right below the first";
  EXPECT_EQ(of[6], Clusters::kNone) << "between them";
  EXPECT_EQ(of[10], 1) << "right below the second";
}

TEST(Clusters, HeightAndReachEnd) {
  Echoes echoes;
  echoes.add(5.0F, 0.0F, 4.4F);
  echoes.add(5.0F, 0.0F, 4.6F);
  echoes.add(5.0F, 5.0F, -0.1F);
  echoes.add(19.0F, 0.0F, 1.0F);
  echoes.add(21.0F, 0.0F, 1.0F);
  echoes.add(0.0F, -21.0F, 1.0F);
  echoes.add(8.0F, 0.0F, std::numeric_limits<float>::infinity());
  const int none = Clusters::kNone;
  EXPECT_EQ(clustersOf(echoes, 20.0, kOptions), (std::vector<int>{0, none, none, 1, none, none, none}));
}

TEST(Clusters, WhatIsKnownToBelongTogetherIsOne) {
  Echoes echoes;
  echoes.add(5.0F, 0.0F, 1.0F);
  echoes.add(9.1F, 9.0F, 1.0F);
  echoes.add(5.3F, 0.0F, 1.0F);  // from here on there are numbers
  echoes.add(5.0F, 3.0F, 1.0F);
  echoes.add(5.0F, -3.0F, 1.0F);
  echoes.add(9.0F, 9.0F, 1.0F);  // and from here on they are far
  echoes.add(5.0F, -3.1F, 1.0F);
  Clusters clusters(60.0, kOptions);
  clusters.connect(echoes.sensor, echoes.points, echoes.heights, echoes.roles, {2, 2, {2, 2, 0, 2, 3}});
  EXPECT_EQ(clusters.of(2), clusters.of(0)) << "it touches";
  EXPECT_EQ(clusters.of(3), clusters.of(0)) << "it is known";
  EXPECT_EQ(clusters.of(5), clusters.of(0)) << "it is far";
  EXPECT_NE(clusters.of(1), clusters.of(0)) << "what is far connects nothing";
  EXPECT_NE(clusters.of(4), clusters.of(0)) << "nothing is known of it";
  EXPECT_EQ(clusters.of(6), Clusters::kNone) << "nothing near has its number";
  EXPECT_EQ(clusters.echoesIn(clusters.of(0)), 4U);
  EXPECT_EQ(clusters.members().size(), 6U);
}

TEST(Clusters, EachScanStartsAnew) {
  Echoes many, few;
  for (int i = 0; i < 50; ++i) many.add(static_cast<float>(i % 7), static_cast<float>(i), 1.0F);
  few.add(0.1F, 0.1F, 1.0F);
  few.add(2.1F, 0.1F, 1.0F);
  Clusters clusters(60.0, kOptions);
  clusters.connect(many.sensor, many.points, many.heights, many.roles);
  EXPECT_GT(clusters.count(), 5);
  clusters.connect(few.sensor, few.points, few.heights, few.roles);
  EXPECT_EQ(clusters.count(), 2);
  clusters.connect({0.0F, 0.0F, 0.0F}, {}, {}, {});
  EXPECT_EQ(clusters.count(), 0);
}

}  // namespace
}  // namespace donex
