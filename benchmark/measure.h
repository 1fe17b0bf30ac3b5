// Times a scan, and how Google Benchmark is told of them.
#pragma once

#include <functional>

#include <benchmark/benchmark.h>

#include "donex/detector.h"
#include "scans.h"

namespace donex::benchmark {

/// CPU time per scan [ms], of all threads; the machine may be busy with other work.
struct Measured {
  double median = 0.0, p99 = 0.0, least = 0.0;
  double wall = 0.0;  ///< median of the elapsed time [ms]
};

/// Shows `work` every scan, `rounds` times over; the first two of a round warm up.
Measured measure(const Scans& scans, int rounds, const std::function<void(const Scan&)>& work);

/// The body of a benchmark: every iteration is one scan through `detector`, which starts anew when the scans are
/// at their end (untimed, with the first two again). Adds the counters of report(), memory_MB and echoes.
Measured timeDetector(::benchmark::State& state, Detector& detector, const Scans& scans);

/// Adds the counters median_ms, p99_ms, least_ms and wall_ms.
void report(::benchmark::State& state, const Measured& measured);

/// Adds the counters floor_ms and of_floor (a ratio of medians) and least_of_floor (of the least times, which other
/// load disturbs less); with a naive reference naive_ms, naive_over_this and least_naive_over_this.
void compare(::benchmark::State& state, const Measured& measured, const Measured& floor, const Measured* naive);

}  // namespace donex::benchmark
