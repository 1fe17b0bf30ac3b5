// A turn of a sensor as the clouds in which a driver sends it that does not wait for the turn.
#pragma once

#include <cstdint>
#include <vector>

#include "simulation/simulated_echo.h"
#include "simulation/simulator_options.h"

namespace donex::simulation {

/// When a part of a turn comes [s].
struct PartTimes {
  double stamp;  ///< that its echoes are given for
  double sent;
};

/// With distortion a part holds what was fired in its share of the turn, and is complete at its end. Without, all
/// echoes are given for the end of the turn: the parts are sectors of equal azimuth, counter-clockwise from straight
/// ahead, sent one after the other from then on.
class TurnParts {
 public:
  explicit TurnParts(const SimulatorOptions& options);

  std::size_t count() const { return echoes_of_part_.size(); }
  /// `end` of the turn [s].
  PartTimes timesOf(std::size_t part, double end) const;

  void cut(const std::vector<SimulatedEcho>& echoes);
  /// Which echoes of the turn that was cut last a part has, in their order.
  const std::vector<std::uint32_t>& echoesOf(std::size_t part) const { return echoes_of_part_.at(part); }

 private:
  std::size_t partOf(const SimulatedEcho& echo) const;
  double shareOf(std::size_t part) const { return static_cast<double>(part) / static_cast<double>(count()); }

  double duration_;  // of a turn [s]
  bool distortion_;
  std::vector<std::vector<std::uint32_t>> echoes_of_part_;
};

}  // namespace donex::simulation
