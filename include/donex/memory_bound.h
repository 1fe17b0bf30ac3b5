// How much memory a configuration takes, known before it is taken.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "donex/config.h"

namespace donex {

constexpr std::size_t kUsualScan = 120000;  // echoes; what a configuration is judged by

/// What the detector of a sound configuration takes for scans of up to `echoes` echoes [bytes]; 0 echoes: before the
/// first scan. Any configuration can be asked. On a grid that scrolls, Detector::memoryBytes comes to that within 10 %:
///  - the paper's rule after the first scan, and it never grows;
///  - with evidence once as many scans are kept as may be, as long as surfaces fill no more bricks than the ground plan
///    has (a wood may). What a sensor does not cover is reserved, not used: the system gives less.
/// Where turns come in parts, the evidence needs up to 45 bytes per echo of a turn more.
/// For the comparison methods: their dense grids alone.
double memoryBound(const Config& config, std::size_t echoes);

/// Every fault of a configuration, one sentence each; empty when it can be used. What Config::faults() says, and where
/// that is nothing, whether the grid needs more than `memory_limit` for a usual scan.
std::vector<std::string> faultsOf(const Config& config);

}  // namespace donex
