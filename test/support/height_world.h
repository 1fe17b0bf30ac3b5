// Scans of a world that is a height over x, y: enough for ground, with objects that stand on it.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include <Eigen/Core>

namespace donex::testing {

struct Block {
  double x_min, x_max, y_min, y_max, height;  ///< above the ground [m]
  bool holds(double x, double y) const { return x >= x_min && x <= x_max && y >= y_min && y <= y_max; }
};

struct HeightWorld {
  std::function<double(double, double)> ground = [](double, double) { return 0.0; };
  std::vector<Block> blocks;

  double surface(double x, double y) const {
    double rise = 0.0;
    for (const Block& block : blocks) rise = std::max(rise, block.holds(x, y) ? block.height : 0.0);
    return ground(x, y) + rise;
  }

  /// What a sensor of `beams` beams sees from `sensor` up to `reach` [m], a ray followed in small steps.
  std::vector<Eigen::Vector3f> seenFrom(const Eigen::Vector3d& sensor, double reach, int beams = 40) const {
    std::vector<Eigen::Vector3f> echoes;
    for (int azimuth = 0; azimuth < 360; ++azimuth) {
      const double angle = azimuth * 3.14159265358979 / 180.0;
      for (int beam = 0; beam < beams; ++beam) {
        const double slope = -0.45 + 0.5 * beam / beams;
        for (double away = 0.5; away < reach; away += 0.05) {
          const Eigen::Vector3d p = sensor + away * Eigen::Vector3d(std::cos(angle), std::sin(angle), slope);
          if (p.z() > surface(p.x(), p.y())) continue;
          echoes.push_back(p.cast<float>());
          break;
        }
      }
    }
    return echoes;
  }
};

}  // namespace donex::testing
