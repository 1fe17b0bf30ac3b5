// How solid-state and non-repetitive sensors look around: fields of view, rays a second, and the way of the rays.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "simulation/sensor_model.h"

namespace donex::simulation {

enum class PatternKind : std::uint8_t {
  kSpinning,       ///< rings of beams, the same each turn
  kSolidState,     ///< a raster in front of the sensor, the same each scan
  kNonRepetitive,  ///< a rosette of two turning prisms, or a zigzag all around: each scan looks where none did before
};

struct Pattern {
  const char* name;
  const char* meaning;
  PatternKind kind;
  double width;     ///< of the field of view, around straight on [deg]
  double lowest;    ///< [deg]
  double highest;   ///< [deg]
  double ray_rate;  ///< rays a second
  float min_range;  ///< [m]
  int lines;        ///< lasers that take turns
};

/// The one place: spinning solid_state non_repetitive mid360 avia hap.
const std::vector<Pattern>& patterns();
const std::vector<std::string>& patternNames();
const Pattern* findPattern(const std::string& name);

/// The rays of one scan; of a non-repetitive pattern each scan has others.
class ScanPattern {
 public:
  /// Not of spinning patterns. `duration` of a scan [s].
  ScanPattern(const Pattern& pattern, double duration, std::uint64_t seed);

  /// Overwrites `model`. The number of rays is the same in every scan.
  void aim(std::size_t scan, SensorModel& model) const;

 private:
  void aimRaster(SensorModel& model) const;
  void aimRosette(std::size_t scan, SensorModel& model) const;

  Pattern pattern_;
  double duration_;
  int rays_;
  double phases_[2];  // of the two movements, 0 to 1
};

}  // namespace donex::simulation
