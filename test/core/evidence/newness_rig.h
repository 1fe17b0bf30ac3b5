// What newness needs around it, and a room in which places become new again and again.
#pragma once

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "core/evidence/newness.h"

namespace donex::testing {

inline Config gridOf(double voxel_size = 0.5) {
  Config config;
  config.voxel_size = voxel_size;
  config.region = {-12.0, 12.0, -12.0, 12.0, -2.0, 3.0};
  return config;
}

/// What the detector does around newness: the window, the points, the history.
template <class Newness>
class Rig {
 public:
  explicit Rig(const Config& config)
      : newness(config),
        clock(config.evidence.birth_age ? config.evidence.birth_window : 0.0),
        history(config.evidence.history_length, 0.0, static_cast<float>(config.evidence.sight_margin),
                {config.evidence.careful_sight, 0.038}) {}

  /// Places of the scan's echoes; `check(echo in the window, the same in m, place)` for those in the grid.
  template <class Check>
  void process(const Scan& scan, Check&& check) {
    const std::vector<std::uint8_t> is_echo(scan.echoes.size(), 1);
    if (history.arrive(scan, is_echo) != TurnPart::kContinuing) clock.begin(scan.stamp);
    newness.shift(scan.odom_from_base);
    const GridWindow& window = newness.window();
    GridScan in_grid;
    window.enter(scan, in_grid);
    const Eigen::Vector3d corner = window.minIndex().template cast<double>() * window.voxelSize();
    before = history.seenBefore(window.odomFromGrid() * Eigen::Translation3d(corner));
    for (std::size_t i = 0; i < scan.echoes.size(); ++i) {
      if (in_grid.inside[i] == 0) continue;
      const Eigen::Vector3f point = in_grid.echoes[i] * static_cast<float>(window.voxelSize());
      check(in_grid.echoes[i], point, newness.judge(in_grid.echoes[i], point, clock, before));
    }
    history.add(scan, is_echo);
  }

  /// Place of the scan's first echo.
  Place first(const Scan& scan) {
    std::vector<Place> places;
    process(scan, [&](const Eigen::Vector3f&, const Eigen::Vector3f&, Place place) { places.push_back(place); });
    return places.at(0);
  }

  Newness newness;
  ScanClock clock;
  SightHistory history;
  SightView before;  ///< of the scans before the present one, asked in its points
};

/// Walls ahead by sector, each now near, now far, now gone, now out of view; the vehicle drives and turns.
class RestlessRoom {
 public:
  RestlessRoom(unsigned seed, bool moves) : random_(seed), moves_(moves) { ranges_.fill(9.0); }

  Scan next() {
    constexpr std::array<double, 6> kRanges{2.5, 5.0, 7.0, 9.0, 30.0, kOutOfView};
    for (double& range : ranges_) {
      if (uniform(0, 1) < 0.15) range = kRanges[std::uniform_int_distribution<std::size_t>(0, 5)(random_)];
    }
    if (moves_) {
      pose_ = pose_ * Eigen::Translation3d(uniform(0, 0.4), 0.0, uniform(-0.2, 0.2)) *
              Eigen::AngleAxisd(uniform(-0.03, 0.04), Eigen::Vector3d::UnitZ());
    }
    Scan scan;
    scan.stamp = stamp_ += uniform(0.05, 0.2);
    scan.odom_from_base = pose_;
    for (int azimuth = -90; azimuth < 90; ++azimuth) {  // 0.7 degrees each
      for (int beam = -2; beam <= 2; ++beam) {
        if (uniform(0, 1) < 0.1) continue;
        const double angle = (azimuth + uniform(-0.1, 0.1)) * M_PI / 260.0, slope = 0.03 * beam;
        const double wall = ranges_[static_cast<std::size_t>((azimuth + 90) / 12)];
        if (wall == kOutOfView) continue;
        const double range = wall + uniform(-0.2, 0.2);
        scan.echoes.push_back((range * Eigen::Vector3d(std::cos(angle), std::sin(angle), slope)).cast<float>());
      }
    }
    return scan;
  }

 private:
  static constexpr double kOutOfView = 0.0;
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

  std::mt19937 random_;
  bool moves_;
  std::array<double, 15> ranges_{};
  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
  double stamp_ = 0.0;
};

}  // namespace donex::testing
