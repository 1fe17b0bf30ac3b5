// The clocks and the quantile behind every time that programs and benchmarks tell.
#pragma once

#include <vector>

namespace donex {

/// CPU time of all threads of the process so far [s].
double cpuTime();

/// A clock that never jumps, from an arbitrary origin [s].
double wallTime();

/// The value below which `fraction` (0 to 1) of the values lie (nearest rank); 0 without values.
double quantile(std::vector<double> values, double fraction);

}  // namespace donex
