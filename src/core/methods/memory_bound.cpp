#include "donex/memory_bound.h"

#include <cstdint>

#include "core/grid/grid_2d.h"
#include "core/grid/grid_window.h"
#include "core/grid/voxel_memory.h"
#include "core/methods/detectors.h"
#include "core/sight/ray_index.h"

namespace donex {
namespace {

/// Peopleremover's bit masks; the other methods for comparison have no dense grid.
double comparisonBytes(const Config& config) {
  constexpr double kMasks = 3.0 * sizeof(std::uint64_t);
  const bool has_grid = config.method == Method::kPeopleremover;
  return has_grid ? kMasks * (GridWindow::extentOf(config.scrolling()) / GridWindow::kBrick).prod() : 0.0;
}

/// The grid of the paper's rule, and what it keeps of a scan.
double paperBytes(const Config& config, double echoes) {
  const Eigen::Vector3d extent = GridWindow::extentOf(config);
  if (config.method == Method::kDonex2d) return Grid2d::bytesFor(extent.head<2>().prod(), echoes, config.threads);
  return VoxelMemory::bytesFor((extent / GridWindow::kBrick).prod(), echoes, config.threads) +
         RayIndex::bytesFor(echoes, config.threads);
}

}  // namespace

double memoryBound(const Config& config, std::size_t echoes) {
  constexpr double kLabels = 2.0;  // bytes per echo
  const auto count = static_cast<double>(echoes);
  if (config.isPaper()) return paperBytes(config, count) + kLabels * count;
  return config.hasEvidence() ? evidenceBytes(config, count) : comparisonBytes(config);
}

}  // namespace donex
