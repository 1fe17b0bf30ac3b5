#include "simulation/ground.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulation/random.h"

namespace donex::simulation {
namespace {

constexpr double kCamber = 0.02;         // rise from a road's edge towards its middle
constexpr double kKerbRun = 0.05;        // [m]
constexpr double kVergeRun = 6.0;        // [m]
constexpr double kSlopeRounding = 12.0;  // [m]
constexpr double kClod = 0.5;            // [m]
constexpr std::uint32_t kRoadLabel = 40;
constexpr std::uint32_t kPavementLabel = 48;

double smoothStep(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * (3.0 - 2.0 * x);
}

/// 0 before, u after, rounded in between.
double softRamp(double u) { return 0.5 * (u + std::sqrt(u * u + kSlopeRounding * kSlopeRounding)); }

}  // namespace

Ground::Ground(const GroundStyle& style, std::uint64_t seed)
    : style_(style), seed_(static_cast<std::uint32_t>(scramble(seed))) {
  Random random(seed);
  for (const double length : {71.0, 37.0, 19.0, 9.0}) {
    const double direction = random.uniform(0.0, 6.28);
    const double number = 6.283185307 / length;
    waves_.push_back({number * Eigen::Vector2d(std::cos(direction), std::sin(direction)),
                      style.waves * length / 71.0 * random.uniform(0.7, 1.3), random.uniform(0.0, 6.28)});
  }
}

double Ground::beyondEdge(const Eigen::Vector2d& place) const {
  double beyond = std::numeric_limits<double>::infinity();
  for (const Road& road : roads_) beyond = std::min(beyond, road.middle.project(place).distance - road.half_width);
  return beyond;
}

double Ground::wide(const Eigen::Vector2d& place) const {
  double height = 0.0;
  for (const Wave& wave : waves_) height += wave.height * std::sin(wave.number.dot(place) + wave.phase);
  for (const Slope& slope : slopes_) {
    const double u = (place - slope.start).dot(Eigen::Vector2d(std::cos(slope.yaw), std::sin(slope.yaw)));
    height += slope.grade * (softRamp(u) - softRamp(u - slope.length));
  }
  return height;
}

double Ground::clods(const Eigen::Vector2d& place) const {
  const Eigen::Vector2d scaled = place / kClod;
  const int x = static_cast<int>(std::floor(scaled.x()));
  const int y = static_cast<int>(std::floor(scaled.y()));
  const double u = smoothStep(scaled.x() - x);
  const double v = smoothStep(scaled.y() - y);
  const auto corner = [this](int i, int j) { return static_cast<double>(cellHash(i, j, 0, seed_) >> 40) * 0x1p-24; };
  const double near = corner(x, y) * (1.0 - u) + corner(x + 1, y) * u;
  const double far = corner(x, y + 1) * (1.0 - u) + corner(x + 1, y + 1) * u;
  return style_.roughness * (near * (1.0 - v) + far * v);
}

GroundPoint Ground::at(const Eigen::Vector2d& place) const {
  const double beyond = beyondEdge(place);
  const double height = wide(place);
  if (beyond < 0.0) return {height + kCamber * std::min(-beyond, 4.0), kRoadLabel};
  const double kerb = style_.kerb_height * std::min(1.0, beyond / kKerbRun);
  const double on_land = beyond - style_.pavement_width;
  if (on_land < 0.0) return {height + kerb, kPavementLabel};
  const double rough = clods(place) * std::min(1.0, on_land);
  return {height + kerb - style_.verge_drop * smoothStep(on_land / kVergeRun) + rough, style_.land_label};
}

}  // namespace donex::simulation
