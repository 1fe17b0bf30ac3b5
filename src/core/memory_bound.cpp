#include "donex/core/memory_bound.h"

#include "donex/core/grid_2d.h"
#include "donex/core/grid_3d.h"
#include "donex/core/grid_window.h"

namespace donex {
namespace {

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

/// The grid of the paper's rule, and what it keeps of a scan.
double paperBytes(const Config& config, double slots, double echoes) {
  return config.method == Method::kDonex2d ? Grid2d::bytesFor(slots, echoes, config.threads)
                                           : Grid3d::bytesFor(slots, echoes, config.threads);
}

}  // namespace

double gridBytes(const Config& config) {
  const bool is_paper = config.isPaper();
  const Eigen::Vector3d extent = GridWindow::extentOf(is_paper ? config : config.scrolling());
  const bool is_flat = config.method == Method::kDonex2d;
  const double slots = is_flat ? extent.head<2>().prod() : (extent / GridWindow::kBrick).prod();
  if (is_paper) return paperBytes(config, slots, 0.0);
  // Clusters look at the ground plan in cells, and in cells of half the size.
  const double cells_along = extent.head<2>().maxCoeff() * config.voxel_size / config.objects.cell;
  const double ground_plans =
      config.hasEvidence() && config.objects.enabled ? 5.0 * sizeof(int) * cells_along * cells_along : 0.0;
  return slots * bytesASlot(config.method) + ground_plans;
}

double memoryBound(const Config& config, std::size_t echoes) {
  constexpr double kLabels = 2.0;       // bytes an echo
  constexpr double kJudgedEcho = 80.0;  // with evidence: places, heights, standing, pixels, clusters
  const auto count = static_cast<double>(echoes);
  const double of_scan =
      config.isPaper() ? paperBytes(config, 0.0, count) - paperBytes(config, 0.0, 0.0) : kJudgedEcho * count;
  return gridBytes(config) + of_scan + kLabels * count;
}

}  // namespace donex
