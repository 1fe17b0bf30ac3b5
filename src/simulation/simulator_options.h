// Everything that can be chosen of a simulated drive, with default, unit, range and meaning: the one place for it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/sector.h"
#include "simulation/disturbance.h"
#include "simulation/rig.h"
#include "simulation/scan_pattern.h"

namespace donex::simulation {

/// How the reported odometry differs from the true motion. White noise: each axis, each sample.
struct OdometryOptions {
  double rate = 50.0;              // [Hz]
  double position_noise = 0.003;   // [m]
  double rotation_noise = 0.0003;  // [rad]
  double drift = 0.003;
  double yaw_drift = 0.0001;     // [rad/m]
  double linear_noise = 0.02;    // [m/s]
  double angular_noise = 0.002;  // [rad/s]
  double stamp_offset = 0.0;     // [s]

  /// No error at all: the true motion, at the same rate.
  static OdometryOptions exact();

  /// Samples before the scene's beginning: by its own stamps the odometry covers the first scan.
  long early() const;
  /// Stamp of the first sample, where the scene begins at 0 [s].
  double firstStamp() const { return stamp_offset - static_cast<double>(early()) / rate; }
};

struct SimulatorOptions {
  int seed = 1;
  int beams = 0;
  std::string pattern = "spinning";
  double view_width = 0.0;   // [deg]
  double view_height = 0.0;  // [deg]
  double ray_rate = 0.0;     // [1/s]
  double duration = 20.0;    // [s]
  double scan_rate = 10.0;   // [Hz]
  double start_stamp = 0.0;  // [s]
  bool distortion = false;
  int parts = 1;
  std::string rig = "single";
  double range_noise = 0.015;  // [m]
  double dropout = 0.01;
  double max_range = 120.0;  // [m]
  DisturbanceOptions disturbance;
  OdometryOptions odometry;

  /// Every fault, one sentence each; empty when the options can be used.
  std::vector<std::string> faults() const;

  /// The pattern as chosen, with what is said otherwise of it. Throws std::out_of_range for an unknown one.
  Pattern chosenPattern() const;
  /// Where the sensors sit. Throws std::out_of_range for an unknown rig.
  const std::vector<Mounting>& mountings() const;
  /// Turns in the whole duration; 0: endless.
  std::size_t turns() const;
};

struct OptionInfo {
  const char* name;
  const char* unit;     ///< empty where it has no unit
  const char* meaning;  ///< one sentence
};

/// Shows `visit` every option, in the order of the documentation, as one of
///   visit(info, double&, min, max)   visit(info, int&, min, max)   visit(info, bool&)   visit(info, std::string&,
///   names)
/// `options` is a SimulatorOptions, const or not.
template <class Options, class Visitor>
void visitOptions(Options& options, Visitor&& visit) {
  constexpr int kMostSeeds = 2147483647;
  visit(OptionInfo{"seed", "", "varies the scene and all noise; the same seed gives the same scans bit for bit"},
        options.seed, 0, kMostSeeds);
  visit(OptionInfo{"beams", "", "16, 32, 64 or 128; 0: what suits the scene (64; empty_room 16)"}, options.beams, 0,
        128);
  visit(OptionInfo{"pattern", "", "how the sensor looks around"}, options.pattern, patternNames());
  visit(OptionInfo{"view_width", "deg", "field of view of a pattern that is not spinning; 0: the pattern's own"},
        options.view_width, 0.0, 360.0);
  visit(OptionInfo{"view_height", "deg", "the same, around its middle; 0: the pattern's own"}, options.view_height, 0.0,
        120.0);
  visit(OptionInfo{"ray_rate", "1/s", "rays a second of a pattern that is not spinning; 0: the pattern's own"},
        options.ray_rate, 0.0, 1e7);
  visit(OptionInfo{"duration", "s", "simulated time; 0: endless"}, options.duration, 0.0, 1e6);
  visit(OptionInfo{"scan_rate", "Hz", "turns of the sensor a second"}, options.scan_rate, 1.0, 50.0);
  visit(OptionInfo{"start_stamp", "s", "stamp at which the scene begins; the first scan is complete one turn later"},
        options.start_stamp, 0.0, 4e9);
  visit(OptionInfo{"distortion", "", "echoes measured one after the other while the vehicle moves, each with its time"},
        options.distortion);
  visit(OptionInfo{"parts", "", "clouds a turn; with distortion each at its own time, without sectors around"},
        options.parts, 1, static_cast<int>(kMostSectors));
  visit(OptionInfo{"rig", "", "the sensors on the vehicle, on one topic"}, options.rig, rigNames());
  visit(OptionInfo{"range_noise", "m", "along the ray, standard deviation"}, options.range_noise, 0.0, 1.0);
  visit(OptionInfo{"dropout", "", "fraction of the echoes that are lost without a reason"}, options.dropout, 0.0, 1.0);
  visit(OptionInfo{"max_range", "m", "no echo comes from further away"}, options.max_range, 5.0, 300.0);
  visitDisturbances<OptionInfo>(options.disturbance, visit);

  auto& odometry = options.odometry;
  visit(OptionInfo{"odometry_rate", "Hz", "odometry samples a second"}, odometry.rate, 1.0, 1000.0);
  visit(OptionInfo{"odometry_position_noise", "m", "white, each axis, standard deviation"}, odometry.position_noise,
        0.0, 1.0);
  visit(OptionInfo{"odometry_rotation_noise", "rad", "white, each axis, standard deviation"}, odometry.rotation_noise,
        0.0, 0.5);
  visit(OptionInfo{"odometry_drift", "", "error of the travelled length, as a fraction of it"}, odometry.drift, 0.0,
        0.5);
  visit(OptionInfo{"odometry_yaw_drift", "rad/m", "heading lost on the way"}, odometry.yaw_drift, 0.0, 0.1);
  visit(OptionInfo{"odometry_linear_noise", "m/s", "of the reported velocity, each axis, standard deviation"},
        odometry.linear_noise, 0.0, 10.0);
  visit(OptionInfo{"odometry_angular_noise", "rad/s", "of the reported turn rate, each axis, standard deviation"},
        odometry.angular_noise, 0.0, 1.0);
  visit(OptionInfo{"odometry_stamp_offset", "s", "added to the stamps of the odometry"}, odometry.stamp_offset, -1.0,
        1.0);
}

}  // namespace donex::simulation
