#include "donex/detector.h"

#include <stdexcept>

#include "core/methods/method_list.h"
#include "donex/memory_bound.h"

namespace donex {

void requireSound(const Config& config) {
  const std::vector<std::string> faults = faultsOf(config);
  if (faults.empty()) return;
  std::string text = "configuration refused:";
  for (const std::string& fault : faults) text += "\n  " + fault;
  throw std::invalid_argument(text);
}

std::unique_ptr<Detector> makeDetector(const Config& config) {
  requireSound(config);
  const MethodEntry& entry = entryOf(config.method);
  if (entry.info.needs_whole_drive) {
    throw std::invalid_argument(std::string("method ") + entry.info.name +
                                " judges a drive when all of it has been seen, it cannot run live: give the recording "
                                "to donex_bag, or a sequence to donex_sequence or donex_map");
  }
  return entry.make_live(config);
}

std::unique_ptr<WholeDriveDetector> makeWholeDriveDetector(const Config& config) {
  requireSound(config);
  const MethodEntry& entry = entryOf(config.method);
  if (!entry.info.needs_whole_drive) {
    throw std::invalid_argument(std::string("method ") + entry.info.name + " runs live");
  }
  return entry.make_whole_drive(config);
}

}  // namespace donex
