#include "donex/memory_bound.h"

#include <sstream>

#include "core/methods/method_list.h"

namespace donex {

double memoryBound(const Config& config, std::size_t echoes) {
  return entryOf(config.method).bytes(config, static_cast<double>(echoes));
}

std::vector<std::string> faultsOf(const Config& config) {
  std::vector<std::string> faults = config.faults();
  if (!faults.empty()) return faults;  // a region without bounds cannot be counted in cells
  const double megabytes = memoryBound(config, kUsualScan) / 1e6;
  if (megabytes > config.memory_limit) {
    std::ostringstream text;
    text << "the grid needs " << megabytes << " MB for scans of " << kUsualScan << " echoes, more than memory_limit ("
         << config.memory_limit << " MB): choose a smaller region or a larger voxel_size";
    faults.push_back(text.str());
  }
  return faults;
}

}  // namespace donex
