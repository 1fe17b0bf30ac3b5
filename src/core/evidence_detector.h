// Either grid with evidence: the default.
#pragma once

#include "donex/core/detector.h"

namespace donex {

std::unique_ptr<Detector> makeEvidenceDetector3d(const Config& config);
std::unique_ptr<Detector> makeEvidenceDetector2d(const Config& config);

/// What either takes for scans of so many echoes [bytes], see memoryBound.
double evidenceBytes(const Config& config, double echoes);

}  // namespace donex
