// Matter that lies: echoes of what is no object, added to a scan with their truth.
#pragma once

#include <cstdint>
#include <vector>

#include "simulation/simulated_echo.h"

namespace donex::simulation {

/// Everything off by default. Shares are of the echoes, 0 to 1.
struct DisturbanceOptions {
  double rain = 0.0;          ///< share that drops stop
  double rain_reach = 10.0;   ///< [m] drops farther away return nothing
  double snow = 0.0;          ///< share that flakes stop
  double dust = 0.0;          ///< share that a cloud behind the vehicle stops, of what crosses its middle
  double spray = 0.0;         ///< the same of the plumes behind the rear wheels
  bool own_body = false;      ///< roof and bonnet are seen
  double dual_returns = 0.0;  ///< share with a second echo behind the first
  double bloom = 0.0;         ///< echoes around each echo of a retro-reflector

  bool any() const;
};

/// Shows `visit` every option, as visitOptions does; `Info` is OptionInfo.
template <class Info, class Options, class Visitor>
void visitDisturbances(Options& options, Visitor&& visit) {
  visit(Info{"rain", "", "share of the echoes that drops stop"}, options.rain, 0.0, 1.0);
  visit(Info{"rain_reach", "m", "drops farther away return nothing; heavy rain is denser and seen less far"},
        options.rain_reach, 2.0, 50.0);
  visit(Info{"snow", "", "share of the echoes that flakes stop, up to 20 m away"}, options.snow, 0.0, 1.0);
  visit(Info{"dust", "", "share that a cloud 3 to 10 m behind the sensor stops, of what crosses its middle"},
        options.dust, 0.0, 1.0);
  visit(Info{"spray", "", "the same of plumes behind the rear wheels"}, options.spray, 0.0, 1.0);
  visit(Info{"own_body", "", "the vehicle's own roof and bonnet are seen: 400 echoes more a scan"}, options.own_body);
  visit(Info{"dual_returns", "", "share of the echoes with a second one 0.3 to 8 m behind"}, options.dual_returns, 0.0,
        1.0);
  visit(Info{"bloom", "", "echoes more around each echo of a retro-reflector (intensity from 0.9)"}, options.bloom, 0.0,
        20.0);
}

/// Echoes of drops and clouds take the place of the echo they hide; bodies, second returns and halos come on top. All
/// are static in truth (kDisturbed), but the halo of something that moves, which is not judged.
class Disturbance {
 public:
  Disturbance(const DisturbanceOptions& options, std::uint64_t seed) : options_(options), seed_(seed) {}

  /// Of scan number `scan`; one label per echo. The sensor sits upright on a roof, x forward. The same seed, number and
  /// echoes give the same result.
  void apply(std::size_t scan, std::vector<SimulatedEcho>& echoes, std::vector<std::uint32_t>& labels) const;

  static constexpr std::uint32_t kDisturbed = 9;  ///< static, of no class

 private:
  DisturbanceOptions options_;
  std::uint64_t seed_;
};

}  // namespace donex::simulation
