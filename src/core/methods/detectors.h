// The factories of the live methods, and what their memory comes to: rows of method_list.cpp.
#pragma once

#include <memory>

#include "donex/detector.h"

namespace donex {

// Either grid with evidence: the default.
std::unique_ptr<Detector> makeEvidenceDetector3d(const Config& config);
std::unique_ptr<Detector> makeEvidenceDetector2d(const Config& config);
/// What either takes for scans of so many echoes [bytes], see memoryBound.
double evidenceBytes(const Config& config, double echoes);

// The paper's rule alone: new is what is hit now and not remembered.
std::unique_ptr<Detector> makePaperDetector3d(const Config& config);
std::unique_ptr<Detector> makeZBufferDetector(const Config& config);
std::unique_ptr<Detector> makePaperDetector2d(const Config& config);
double paperBytes3d(const Config& config, double echoes);
double paperBytes2d(const Config& config, double echoes);

// The live methods of the comparison (algorithm: "Comparison methods"), each in a file of its own.
std::unique_ptr<Detector> makeRangeResidualDetector(const Config& config);
std::unique_ptr<Detector> makeRayTracingDetector(const Config& config);
std::unique_ptr<Detector> makeMotionVoxelGridDetector(const Config& config);

}  // namespace donex
