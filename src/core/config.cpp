#include "donex/core/config.h"

#include <cmath>
#include <sstream>

#include "donex/core/grid_2d.h"
#include "donex/core/grid_3d.h"
#include "donex/core/grid_window.h"
#include "donex/core/memory_bound.h"

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

/// A slot of the memory of a method beyond the paper's rule [bytes]: a brick's number, a cell with three ranges, three
/// bit masks a brick; nothing where a method has no dense grid.
double bytesASlot(Method method) {
  switch (method) {
    case Method::kDonex3d: return 4.0;
    case Method::kDonex2d: return 40.0;
    case Method::kPeopleremover: return 24.0;
    default: return 0.0;
  }
}

bool hasEvidence(const Config& config) {
  const bool may_have = config.method == Method::kDonex3d || config.method == Method::kDonex2d;
  return may_have && (config.evidence.any() || config.objects.enabled);
}

bool isPaper(const Config& config) {
  const bool may_be = config.method == Method::kDonex3d || config.method == Method::kDonex2d;
  return config.method == Method::kDonex3dZBuffer || (may_be && !hasEvidence(config));
}

/// The grid of the paper's rule, and what it keeps of a scan.
double paperBytes(const Config& config, double slots, double echoes) {
  return config.method == Method::kDonex2d ? Grid2d::bytesFor(slots, echoes, config.threads)
                                           : Grid3d::bytesFor(slots, echoes, config.threads);
}

}  // namespace

double Config::gridBytes() const {
  const bool is_paper = isPaper(*this);
  Config scrolling = *this;
  if (!is_paper) scrolling.compensation = Compensation::kScroll;
  const Eigen::Vector3d extent = GridWindow::extentOf(scrolling);
  const bool is_flat = method == Method::kDonex2d;
  const double slots = is_flat ? extent.head<2>().prod() : (extent / GridWindow::kBrick).prod();
  if (is_paper) return paperBytes(*this, slots, 0.0);
  // Clusters look at the ground plan in cells, and in cells of half the size.
  const double cells_along = extent.head<2>().maxCoeff() * voxel_size / objects.cell;
  const double ground_plans =
      hasEvidence(*this) && objects.enabled ? 5.0 * sizeof(int) * cells_along * cells_along : 0.0;
  return slots * bytesASlot(method) + ground_plans;
}

double memoryBound(const Config& config, std::size_t echoes) {
  constexpr double kLabels = 2.0;       // bytes an echo
  constexpr double kJudgedEcho = 80.0;  // with evidence: places, heights, standing, pixels, clusters
  const auto count = static_cast<double>(echoes);
  const double of_scan =
      isPaper(config) ? paperBytes(config, 0.0, count) - paperBytes(config, 0.0, 0.0) : kJudgedEcho * count;
  return config.gridBytes() + of_scan + kLabels * count;
}

std::vector<std::string> Config::faults() const {
  std::vector<std::string> faults;
  Config copy = *this;
  visitParameters(copy, RangeCheck{faults});
  checkExtent("x", region.x_min, region.x_max, voxel_size, faults);
  checkExtent("y", region.y_min, region.y_max, voxel_size, faults);
  checkExtent("z", region.z_min, region.z_max, voxel_size, faults);
  const double megabytes = gridBytes() / 1e6;
  const bool fits = megabytes <= memory_limit;  // false where the region or voxel size is not a number
  if (!fits && faults.empty()) {
    std::ostringstream text;
    text << "the grid needs " << megabytes << " MB, more than memory_limit (" << memory_limit
         << " MB): choose a smaller region or a larger voxel_size";
    faults.push_back(text.str());
  }
  return faults;
}

}  // namespace donex
