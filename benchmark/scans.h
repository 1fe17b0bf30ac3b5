// The scans that are timed: simulated ones, so that everybody times the same.
#pragma once

#include <string>
#include <vector>

#include "donex/scan.h"

namespace donex::benchmark {

using Scans = std::vector<Scan>;

/// The paper's Table 1 setting: `echoes` echoes per scan, all of them in x 0..75 m, y +-25 m of the sensor; a
/// 128-beam sensor in a street, a turned copy fills what one turn leaves open. Built once for each number.
const Scans& scansInFront(std::size_t echoes);

/// Whole turns of a sensor with `beams` beams in `scene`, `count` of them.
const Scans& fullScans(const std::string& scene, int beams, std::size_t count);

/// Whole turns of about `echoes` echoes: a 128-beam sensor's, thinned, or made denser by echoes at a fraction
/// of its azimuth step.
const Scans& scansOf(std::size_t echoes);

}  // namespace donex::benchmark
