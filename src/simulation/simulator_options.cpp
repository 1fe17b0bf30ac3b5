#include "donex/simulation/simulator_options.h"

#include <sstream>

namespace donex::simulation {
namespace {

struct RangeCheck {
  std::vector<std::string>& faults;

  template <class Number>
  void operator()(const OptionInfo& info, Number value, Number low, Number high) {
    const bool inside = value >= low && value <= high;  // false for NaN
    if (inside) return;
    std::ostringstream text;
    text << info.name << " is " << value << ", must be between " << low << " and " << high;
    faults.push_back(text.str());
  }
  void operator()(const OptionInfo&, bool) {}
};

}  // namespace

OdometryOptions OdometryOptions::exact() {
  OdometryOptions options;
  options.position_noise = options.rotation_noise = options.drift = options.yaw_drift = 0.0;
  options.linear_noise = options.angular_noise = 0.0;
  return options;
}

std::vector<std::string> SimulatorOptions::faults() const {
  std::vector<std::string> faults;
  visitOptions(*this, RangeCheck{faults});
  const bool known_beams = beams == 0 || beams == 16 || beams == 32 || beams == 64 || beams == 128;
  const bool within = beams >= 0 && beams <= 128;
  if (within && !known_beams) faults.push_back("beams is " + std::to_string(beams) + ", must be 16, 32, 64, 128 or 0");
  return faults;
}

}  // namespace donex::simulation
