#include "simulation/simulator_options.h"

#include <algorithm>
#include <cmath>
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

long OdometryOptions::early() const {
  constexpr double kLead = 0.1;  // [s]
  return static_cast<long>(std::ceil(std::max(kLead, stamp_offset) * rate));
}

std::size_t SimulatorOptions::scans() const {
  constexpr double kRounding = 1e-6;
  return static_cast<std::size_t>(std::floor(duration * scan_rate + kRounding));
}

std::vector<std::string> SimulatorOptions::faults() const {
  std::vector<std::string> faults;
  visitOptions(*this, RangeCheck{faults});
  const bool known_beams = beams == 0 || beams == 16 || beams == 32 || beams == 64 || beams == 128;
  const bool within = beams >= 0 && beams <= 128;
  if (within && !known_beams) faults.push_back("beams is " + std::to_string(beams) + ", must be 16, 32, 64, 128 or 0");
  const bool ends_early = faults.empty() && duration > 0.0 && scans() == 0;
  if (ends_early) {
    std::ostringstream text;
    text << "duration is " << duration << " s, shorter than a scan, which takes " << 1.0 / scan_rate << " s";
    faults.push_back(text.str());
  }
  return faults;
}

}  // namespace donex::simulation
