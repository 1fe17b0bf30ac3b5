// How much memory a configuration takes, said before it is taken.
#pragma once

#include <cstddef>

#include "donex/core/config.h"

namespace donex {

/// Memory that region and voxel size ask for before the first scan [bytes]; what is held only where
/// something is hit comes on top (Detector::memoryBytes tells it). Any configuration can be asked.
double gridBytes(const Config& config);

/// What the detector of a sound configuration takes for scans of up to `echoes` echoes [bytes]. For the paper's rule on
/// a grid that scrolls, that is what Detector::memoryBytes is after the first scan, within 10 %, and it never grows.
/// With evidence, voxels' records and objects come on top, as much as the surroundings have.
double memoryBound(const Config& config, std::size_t echoes);

}  // namespace donex
