// The live methods of the comparison (algorithm section 6), each in a file of its own.
#pragma once

#include <memory>

#include "donex/core/detector.h"

namespace donex {

std::unique_ptr<Detector> makeRangeResidualDetector(const Config& config);
std::unique_ptr<Detector> makeRayTracingDetector(const Config& config);
std::unique_ptr<Detector> makeMotionVoxelGridDetector(const Config& config);

}  // namespace donex
