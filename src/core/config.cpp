#include "donex/config.h"

#include <cmath>
#include <sstream>

#include "donex/memory_bound.h"
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

}  // namespace

bool Config::hasEvidence() const {
  const bool may_have = method == Method::kDonex3d || method == Method::kDonex2d;
  return may_have && (evidence.any() || objects.enabled);
}

bool Config::isPaper() const {
  const bool may_be = method == Method::kDonex3d || method == Method::kDonex2d;
  return method == Method::kDonex3dZBuffer || (may_be && !hasEvidence());
}

Config Config::scrolling() const {
  Config config = *this;
  config.compensation = Compensation::kScroll;
  return config;
}

Config paperConfig(Method method) {
  Config config;
  config.method = method;
  EvidenceConfig& e = config.evidence;
  e.free_evidence = e.careful_sight = e.birth_age = e.neighbourhood = e.ground = false;
  config.objects.enabled = config.objects.motion = false;
  return config;
}

std::vector<std::string> Config::faults() const {
  std::vector<std::string> faults;
  Config copy = *this;
  visitParameters(copy, RangeCheck{faults});
  checkExtent("x", region.x_min, region.x_max, voxel_size, faults);
  checkExtent("y", region.y_min, region.y_max, voxel_size, faults);
  checkExtent("z", region.z_min, region.z_max, voxel_size, faults);
  if (!faults.empty()) return faults;  // a region without bounds cannot be counted in cells
  const double megabytes = memoryBound(*this, kUsualScan) / 1e6;
  if (megabytes > memory_limit) {
    std::ostringstream text;
    text << "the grid needs " << megabytes << " MB for scans of " << kUsualScan << " echoes, more than memory_limit ("
         << memory_limit << " MB): choose a smaller region or a larger voxel_size";
    faults.push_back(text.str());
  }
  return faults;
}

}  // namespace donex
