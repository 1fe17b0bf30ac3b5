// What a sensor's own scans tell of it (algorithm: "The sensor measures itself").
#pragma once

#include <string>

namespace donex {

/// Of the turn before the newest one.
struct MeasuredSensor {
  double beams_apart = 0.0;            ///< between beams above one another, on average over what it sees [deg]
  double lowest = 0.0, highest = 0.0;  ///< elevations that echoes came back from [deg]
  double around = 0.0;                 ///< azimuths that echoes came back from, all together [deg]
  double turns_per_second = 0.0;       ///< [Hz]
  double second_returns = 0.0;         ///< share of the newest scan's echoes that lie behind another one of their beam
};

/// In one line, for the log and the diagnostics.
std::string describe(const MeasuredSensor& sensor);

}  // namespace donex
