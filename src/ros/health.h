// One line on the state of the classifier, from a few figures.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace donex {

/// Figures of the last seconds.
struct Health {
  double labeled_rate = 0.0;     ///< [Hz]
  double median_time = 0.0;      ///< per scan [s]
  std::optional<double> silent;  ///< since the newest cloud [s]; empty before the first
  bool needs_odometry = true;
  std::optional<double> odometry_age;  ///< since the newest odometry [s]; empty before the first
  std::string odometry_fault;          ///< likely cause; empty where odometry and scans agree
  std::size_t drops = 0;               ///< scans
  std::string last_drop;               ///< why, in a few words
  std::string region_fault;            ///< why hardly anything can be judged; empty where much can
  std::size_t waiting = 0;             ///< scans
  std::string failure;                 ///< an exception; empty without one
};

struct HealthLine {
  enum class Level { kOk, kWarn, kError };
  Level level = Level::kOk;
  std::string text;  ///< begins with the level: "OK: 9.9 Hz, 11 ms a scan"
};

/// Silence of this length is reported [s].
constexpr double kSilence = 1.0;

HealthLine tell(const Health& health);

}  // namespace donex
