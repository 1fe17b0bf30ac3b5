#include "donex/core/config.h"

#include <cmath>
#include <sstream>

namespace donex {
namespace {

/// Collects every value outside its range.
struct RangeCheck {
  std::vector<std::string>& faults;

  void operator()(const ParameterInfo& info, const double& value, double min, double max) {
    check(info, value, min, max, std::isfinite(value));
  }
  void operator()(const ParameterInfo& info, const int& value, int min, int max) { check(info, value, min, max, true); }
  template <class Anything>
  void operator()(const ParameterInfo&, const Anything&) {}

  template <class Number>
  void check(const ParameterInfo& info, Number value, Number min, Number max, bool finite) {
    if (finite && value >= min && value <= max) return;
    std::ostringstream text;
    text << info.name << " is " << value << ", must lie in [" << min << ", " << max << "]";
    if (*info.unit != '\0') text << ' ' << info.unit;
    faults.push_back(text.str());
  }
};

void checkExtent(const char* axis, double min, double max, double voxel_size, std::vector<std::string>& faults) {
  const bool holds_a_voxel = max - min >= voxel_size;
  if (holds_a_voxel) return;
  std::ostringstream text;
  text << axis << "_min is " << min << " and " << axis << "_max is " << max
       << ": the region must be at least one voxel (" << voxel_size << " m) wide";
  faults.push_back(text.str());
}

}  // namespace

std::vector<std::string> Config::faults() const {
  std::vector<std::string> faults;
  Config copy = *this;
  visitParameters(copy, RangeCheck{faults});
  checkExtent("x", region.x_min, region.x_max, voxel_size, faults);
  checkExtent("y", region.y_min, region.y_max, voxel_size, faults);
  checkExtent("z", region.z_min, region.z_max, voxel_size, faults);
  return faults;
}

}  // namespace donex
