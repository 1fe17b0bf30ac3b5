#include "simulation/scan_pattern.h"

#include <algorithm>
#include <cmath>

#include "core/pi.h"
#include "simulation/named.h"
#include "simulation/random.h"

namespace donex::simulation {
namespace {

// Rates of the two movements; their ratio is no simple fraction, so that the pattern does not close.
constexpr double kFirstPrism = 121.567;   // of a rosette [turns/s]
constexpr double kSecondPrism = -77.733;  // [turns/s]
constexpr double kRound = 10.373;         // of a zigzag: around [turns/s]
constexpr double kUpAndDown = 421.71;     // [turns/s]
constexpr double kAllAround = 360.0;      // [deg]
constexpr double kRasterStretch = 2.0;    // columns of a raster lie as many times as far apart as its rows

double radians(double degrees) { return degrees * kPi / 180.0; }

/// 0 up to 1 and back once a turn.
double zigzag(double turns) {
  const double fraction = turns - std::floor(turns);
  return fraction < 0.5 ? 2.0 * fraction : 2.0 - 2.0 * fraction;
}

Eigen::Vector2d headingOf(double azimuth) { return {std::cos(azimuth), std::sin(azimuth)}; }

}  // namespace

const std::vector<Pattern>& patterns() {
  static const std::vector<Pattern> all{
      {"spinning", "rings of beams, see beams", PatternKind::kSpinning, 360.0, 0.0, 0.0, 0.0, 0.9f, 0},
      {"solid_state", "a raster to the front, 120 x 25 deg, 452,000 rays a second", PatternKind::kSolidState, 120.0,
       -12.5, 12.5, 452e3, 0.5f, 0},
      {"non_repetitive", "a zigzag all around, -7 to 52 deg, 200,000 rays a second", PatternKind::kNonRepetitive, 360.0,
       -7.0, 52.0, 200e3, 0.1f, 4},
      {"mid360", "like a Livox Mid-360: the same as non_repetitive", PatternKind::kNonRepetitive, 360.0, -7.0, 52.0,
       200e3, 0.1f, 4},
      {"avia", "like a Livox Avia: a rosette, 70.4 x 77.2 deg, 240,000 rays a second", PatternKind::kNonRepetitive,
       70.4, -38.6, 38.6, 240e3, 1.0f, 6},
      {"hap", "like a Livox HAP: the same as solid_state", PatternKind::kSolidState, 120.0, -12.5, 12.5, 452e3, 0.5f,
       0},
  };
  return all;
}

const std::vector<std::string>& patternNames() {
  static const std::vector<std::string> names = namesOf(patterns());
  return names;
}

const Pattern* findPattern(const std::string& name) { return findNamed(patterns(), name); }

ScanPattern::ScanPattern(const Pattern& pattern, double duration, std::uint64_t seed)
    : pattern_(pattern), duration_(duration), rays_(static_cast<int>(std::lround(pattern.ray_rate * duration))) {
  Random random(scramble(seed, 0x9A77));
  for (double& phase : phases_) phase = random.uniform();
}

void ScanPattern::aim(std::size_t scan, SensorModel& model) const {
  model.slopes.clear();
  model.headings.clear();
  model.min_range = pattern_.min_range;
  model.is_even_turn = false;
  pattern_.kind == PatternKind::kSolidState ? aimRaster(model) : aimRosette(scan, model);
}

void ScanPattern::aimRaster(SensorModel& model) const {
  const double height = pattern_.highest - pattern_.lowest;
  const auto rows =
      std::max(1, static_cast<int>(std::lround(std::sqrt(kRasterStretch * rays_ * height / pattern_.width))));
  const int columns = std::max(1, rays_ / rows);
  for (int row = 0; row < rows; ++row) {
    model.slopes.push_back(static_cast<float>(std::tan(radians(pattern_.lowest + height * (row + 0.5) / rows))));
  }
  for (int column = 0; column < columns; ++column) {
    model.headings.push_back(headingOf(radians(pattern_.width * (0.5 - (column + 0.5) / columns))));
  }
}

void ScanPattern::aimRosette(std::size_t scan, SensorModel& model) const {
  model.one_ray_each = true;
  model.lines = pattern_.lines;
  const double middle = 0.5 * (pattern_.lowest + pattern_.highest);
  const double half_height = 0.5 * (pattern_.highest - pattern_.lowest);
  const double half_width = 0.5 * pattern_.width;
  for (int ray = 0; ray < rays_; ++ray) {
    const double time = duration_ * (static_cast<double>(scan) + (ray + 0.5) / rays_);
    const double line = static_cast<double>(ray % pattern_.lines) / pattern_.lines;
    double azimuth = 0.0;
    double elevation = 0.0;
    if (pattern_.width >= kAllAround) {
      azimuth = -2.0 * kPi * (kRound * time + phases_[0]);
      elevation = pattern_.lowest + 2.0 * half_height * zigzag(kUpAndDown * time + phases_[1] + line);
    } else {
      // The sum of two arrows of the same length that turn: a flower within the unit circle.
      const double first = 2.0 * kPi * (kFirstPrism * time + phases_[0] + line / 7.0);
      const double second = 2.0 * kPi * (kSecondPrism * time + phases_[1] + line / 5.0);
      azimuth = radians(0.5 * half_width * (std::cos(first) + std::cos(second)));
      elevation = middle + 0.5 * half_height * (std::sin(first) + std::sin(second));
    }
    model.headings.push_back(headingOf(azimuth));
    model.slopes.push_back(static_cast<float>(std::tan(radians(elevation))));
  }
}

}  // namespace donex::simulation
