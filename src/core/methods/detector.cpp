#include "donex/detector.h"

#include <stdexcept>

#include "core/methods/detectors.h"
#include "core/methods/people_remover.h"

namespace donex {

void requireSound(const Config& config) {
  const std::vector<std::string> faults = config.faults();
  if (faults.empty()) return;
  std::string text = "configuration refused:";
  for (const std::string& fault : faults) text += "\n  " + fault;
  throw std::invalid_argument(text);
}

std::unique_ptr<Detector> makeDetector(const Config& config) {
  requireSound(config);
  switch (config.method) {
    case Method::kDonex2d: return config.isPaper() ? makePaperDetector2d(config) : makeEvidenceDetector2d(config);
    case Method::kDonex3dZBuffer: return makeZBufferDetector(config);
    case Method::kMotionVoxelGrid: return makeMotionVoxelGridDetector(config);
    case Method::kRayTracing: return makeRayTracingDetector(config);
    case Method::kRangeResidual: return makeRangeResidualDetector(config);
    case Method::kPeopleremover:
      throw std::invalid_argument(
          "method peopleremover judges a drive when all of it has been seen, it cannot run live: give the recording to "
          "donex_bag, or a sequence to donex_sequence or donex_map");
    case Method::kDonex3d: break;
  }
  return config.isPaper() ? makePaperDetector3d(config) : makeEvidenceDetector3d(config);
}

std::unique_ptr<WholeDriveDetector> makeWholeDriveDetector(const Config& config) {
  requireSound(config);
  if (!needsWholeDrive(config.method)) {
    throw std::invalid_argument("method " + nameOf(config.method) + " runs live");
  }
  return makePeopleRemover(config, PeopleRemoverOptions());
}

}  // namespace donex
