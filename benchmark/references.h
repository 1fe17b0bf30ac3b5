// What every method is compared with, timed in the same run.
#pragma once

#include "donex/config.h"
#include "measure.h"
#include "scans.h"

namespace donex::benchmark {

/// The floor: one pass that transforms every echo, computes its cell and touches it once: a byte a cell in 2D, a
/// bit per voxel in 3D. As lean as plain code gets; nothing can be judged with less.
Measured floorOf(Method method, const Config& config, const Scans& scans);

/// The naive way of de-shadowing: the Amanatides-Woo traversal of every line of sight, each voxel touched.
Measured naiveOf(const Config& config, const Scans& scans);

}  // namespace donex::benchmark
