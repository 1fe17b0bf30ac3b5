// Either grid with evidence: the default.
#pragma once

#include "donex/core/detector.h"

namespace donex {

std::unique_ptr<Detector> makeEvidenceDetector3d(const Config& config);
std::unique_ptr<Detector> makeEvidenceDetector2d(const Config& config);

}  // namespace donex
