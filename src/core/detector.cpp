#include "donex/core/detector.h"

#include <stdexcept>

#include "evidence_detector.h"
#include "paper_detectors.h"

namespace donex {

std::unique_ptr<Detector> makeDetector(const Config& config) {
  const std::vector<std::string> faults = config.faults();
  if (!faults.empty()) {
    std::string text = "configuration refused:";
    for (const std::string& fault : faults) text += "\n  " + fault;
    throw std::invalid_argument(text);
  }
  const bool is_paper = !config.evidence.any() && !config.objects.enabled;
  switch (config.method) {
    case Method::kDonex2d: return is_paper ? makePaperDetector2d(config) : makeEvidenceDetector2d(config);
    case Method::kDonex3d: break;
  }
  return is_paper ? makePaperDetector3d(config) : makeEvidenceDetector3d(config);
}

}  // namespace donex
