#include "donex/core/detector.h"

#include <stdexcept>

#include "paper_detectors.h"

namespace donex {

std::unique_ptr<Detector> makeDetector(const Config& config) {
  const std::vector<std::string> faults = config.faults();
  if (!faults.empty()) {
    std::string text = "configuration refused:";
    for (const std::string& fault : faults) text += "\n  " + fault;
    throw std::invalid_argument(text);
  }
  switch (config.method) {
    case Method::kDonex2d: return makePaperDetector2d(config);
    case Method::kDonex3d: break;
  }
  return makePaperDetector3d(config);
}

}  // namespace donex
