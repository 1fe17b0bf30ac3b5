#include "simulation/simulator_options.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

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
  void operator()(const OptionInfo& info, const std::string& value, const std::vector<std::string>& names) {
    if (std::find(names.begin(), names.end(), value) != names.end()) return;
    std::string text = std::string(info.name) + " is '" + value + "'; there are:";
    for (const std::string& name : names) text += " " + name;
    faults.push_back(text);
  }
};

/// What does not go together.
void addPatternFaults(const SimulatorOptions& options, std::vector<std::string>& faults) {
  constexpr double kSteepest = 60.0;  // no ray may be steeper: the ground is followed level [deg]
  constexpr double kFewest = 100.0;   // rays a scan
  if (!faults.empty()) return;
  const Pattern pattern = options.chosenPattern();
  if (pattern.kind == PatternKind::kSpinning) {
    const bool describes_another = options.view_width > 0.0 || options.view_height > 0.0 || options.ray_rate > 0.0;
    if (describes_another) faults.emplace_back("view_width, view_height and ray_rate are not for the spinning pattern");
    return;
  }
  if (options.beams != 0) faults.emplace_back("beams is only for the spinning pattern");
  if (pattern.lowest < -kSteepest || pattern.highest > kSteepest) {
    faults.emplace_back("view_height reaches beyond 60 degrees");
  }
  if (pattern.ray_rate < kFewest * options.scan_rate) faults.emplace_back("ray_rate leaves less than 100 rays a scan");
}

void addRigFaults(const SimulatorOptions& options, std::vector<std::string>& faults) {
  if (!faults.empty()) return;
  const std::vector<Mounting>& mountings = options.mountings();
  const DisturbanceOptions& disturbance = options.disturbance;
  const bool knows_the_vehicle = disturbance.own_body || disturbance.dust > 0.0 || disturbance.spray > 0.0;
  if (mountings.size() > 1 && knows_the_vehicle) {
    faults.emplace_back("own_body, dust and spray are as one sensor on the roof sees them: not with a rig of several");
  }
  constexpr double kAllAround = 360.0;  // [deg]
  const auto sees_half = [](const Mounting& mounting) { return mounting.sees_half; };
  const bool sees_all_around =
      options.chosenPattern().width >= kAllAround && std::none_of(mountings.begin(), mountings.end(), sees_half);
  if (options.parts > 1 && !options.distortion && !sees_all_around) {
    faults.emplace_back(
        "parts without distortion are sectors all around, where these sensors do not look: add distortion");
  }
}

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

Pattern SimulatorOptions::chosenPattern() const {
  const Pattern* found = findPattern(pattern);
  if (found == nullptr) throw std::out_of_range("no pattern '" + pattern + "'");
  Pattern chosen = *found;
  if (view_width > 0.0) chosen.width = view_width;
  if (ray_rate > 0.0) chosen.ray_rate = ray_rate;
  if (view_height > 0.0) {
    const double middle = 0.5 * (chosen.lowest + chosen.highest);
    chosen.lowest = middle - 0.5 * view_height;
    chosen.highest = middle + 0.5 * view_height;
  }
  return chosen;
}

const std::vector<Mounting>& SimulatorOptions::mountings() const {
  const Rig* found = findRig(rig);
  if (found == nullptr) throw std::out_of_range("no rig '" + rig + "'");
  return found->mountings;
}

std::size_t SimulatorOptions::turns() const {
  constexpr double kRounding = 1e-6;
  return static_cast<std::size_t>(std::floor(duration * scan_rate + kRounding));
}

std::vector<std::string> SimulatorOptions::faults() const {
  std::vector<std::string> faults;
  visitOptions(*this, RangeCheck{faults});
  const bool known_beams = beams == 0 || beams == 16 || beams == 32 || beams == 64 || beams == 128;
  const bool within = beams >= 0 && beams <= 128;
  if (within && !known_beams) faults.push_back("beams is " + std::to_string(beams) + ", must be 16, 32, 64, 128 or 0");
  addPatternFaults(*this, faults);
  addRigFaults(*this, faults);
  const bool ends_early = faults.empty() && duration > 0.0 && turns() == 0;
  if (ends_early) {
    std::ostringstream text;
    text << "duration is " << duration << " s, shorter than a scan, which takes " << 1.0 / scan_rate << " s";
    faults.push_back(text.str());
  }
  return faults;
}

}  // namespace donex::simulation
