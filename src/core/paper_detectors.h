// The paper's rule alone, on either grid: new is what is hit now and not remembered.
#pragma once

#include "donex/core/detector.h"

namespace donex {

std::unique_ptr<Detector> makePaperDetector3d(const Config& config);
std::unique_ptr<Detector> makeZBufferDetector(const Config& config);
std::unique_ptr<Detector> makePaperDetector2d(const Config& config);

}  // namespace donex
