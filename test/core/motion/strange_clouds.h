// Clouds that tell no motion, for the tests of registration.
#pragma once

#include <limits>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace donex::testing {

/// What sensors and drivers hand out when something is wrong.
struct StrangeCloud {
  std::string name;
  std::vector<Eigen::Vector3f> echoes;
};

inline std::vector<StrangeCloud> strangeClouds() {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  std::vector<StrangeCloud> clouds;
  clouds.push_back({"empty", {}});
  clouds.push_back({"one echo", {{5.0F, 1.0F, 0.0F}}});
  clouds.push_back({"all NaN", std::vector<Eigen::Vector3f>(5000, Eigen::Vector3f::Constant(kNan))});
  clouds.push_back({"all in the origin", std::vector<Eigen::Vector3f>(5000, Eigen::Vector3f::Zero())});
  clouds.push_back({"one echo many times", std::vector<Eigen::Vector3f>(5000, Eigen::Vector3f(7.0F, 2.0F, 1.0F))});
  clouds.push_back({"huge", std::vector<Eigen::Vector3f>(5000, Eigen::Vector3f::Constant(1e30F))});
  std::vector<Eigen::Vector3f> line, wall, noise;
  std::mt19937 random(5);
  std::uniform_real_distribution<float> number(-30.0F, 30.0F);
  for (int i = 0; i < 5000; ++i) {
    line.emplace_back(5.0F + 0.01F * static_cast<float>(i), 2.0F, 1.0F);
    wall.emplace_back(9.0F, -10.0F + 0.2F * static_cast<float>(i % 100), 0.1F * static_cast<float>(i / 100));
    noise.emplace_back(number(random), number(random), number(random));
  }
  clouds.push_back({"a line", line});
  clouds.push_back({"a wall elsewhere", wall});
  clouds.push_back({"noise", noise});
  return clouds;
}

}  // namespace donex::testing
