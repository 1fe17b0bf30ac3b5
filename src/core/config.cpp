#include "donex/config.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "donex/parameters.h"

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

/// Switches off what goes beyond the paper's rule.
struct StepsOff {
  void operator()(const ParameterInfo& info, bool& value) const {
    if (isBeyondPaper(info)) value = false;
  }
  template <class Anything, class... Range>
  void operator()(const ParameterInfo&, const Anything&, const Range&...) const {}
};

struct Collector {
  std::vector<Parameter>& parameters;

  template <class Value, class... Range>
  void operator()(const ParameterInfo& info, const Value& value, const Range&...) {
    Parameter& parameter = parameters.emplace_back();
    parameter.info = info;
    if constexpr (std::is_enum_v<Value>) {
      parameter.value.emplace<std::string>(nameOf(value));
    } else {
      parameter.value.emplace<Value>(value);
    }
  }
};

/// A box is given whole or not at all.
void checkSelf(const SelfConfig& self, std::vector<std::string>& faults) {
  const auto edges = {self.x_min, self.x_max, self.y_min, self.y_max, self.z_min, self.z_max};
  const bool is_given = std::any_of(edges.begin(), edges.end(), [](double edge) { return edge != 0.0; });
  const bool is_a_box = self.x_min < self.x_max && self.y_min < self.y_max && self.z_min < self.z_max;
  if (is_given && !is_a_box) {
    faults.emplace_back("self_x_min to self_z_max: each min must be less than its max, or all of them 0 for no box");
  }
}

}  // namespace

bool Config::hasEvidence() const {
  return infoOf(method).kind == MethodKind::kDonex && (evidence.any() || objects.enabled);
}

bool Config::isPaper() const {
  const MethodKind kind = infoOf(method).kind;
  return kind == MethodKind::kPaper || (kind == MethodKind::kDonex && !hasEvidence());
}

Config Config::scrolling() const {
  Config config = *this;
  config.compensation = Compensation::kScroll;
  return config;
}

Config paperConfig(Method method, Compensation compensation) {
  Config config;
  config.method = method;
  config.compensation = compensation;
  visitParameters(config, StepsOff());
  return config;
}

std::vector<Parameter> parametersOf(const Config& config) {
  std::vector<Parameter> parameters;
  Config copy = config;
  visitParameters(copy, Collector{parameters});
  return parameters;
}

bool operator==(const Config& a, const Config& b) {
  const std::vector<Parameter> of_a = parametersOf(a), of_b = parametersOf(b);
  const auto is_same = [](const Parameter& x, const Parameter& y) { return x.value == y.value; };
  return std::equal(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(), is_same);
}

std::vector<std::string> Config::faults() const {
  std::vector<std::string> faults;
  Config copy = *this;
  visitParameters(copy, RangeCheck{faults});
  checkExtent("x", region.x_min, region.x_max, voxel_size, faults);
  checkExtent("y", region.y_min, region.y_max, voxel_size, faults);
  checkExtent("z", region.z_min, region.z_max, voxel_size, faults);
  const bool has_origin = std::hypot(cloud.origin_x, cloud.origin_y, cloud.origin_z) > 0.0;
  if (has_origin && !cloud.sensor_frame.empty()) {
    faults.emplace_back("sensor_frame and origin_x, origin_y, origin_z both say where the sensor is: set one of them");
  }
  checkSelf(self, faults);
  return faults;
}

}  // namespace donex
