// Times a scan, and how Google Benchmark is told of them.
#pragma once

#include <functional>
#include <memory>

#include <benchmark/benchmark.h>

#include "donex/core/detector.h"
#include "scans.h"

namespace donex::benchmark {

/// CPU time a scan [ms], of all threads; the machine may be busy with other things.
struct Measured {
  double median = 0.0, p99 = 0.0, least = 0.0;
  double wall = 0.0;  ///< median of the elapsed time [ms]
};

/// Shows `work` every scan, `rounds` times over; the first two of a round warm up.
Measured measure(const Scans& scans, int rounds, const std::function<void(const Scan&)>& work);

/// The body of a benchmark: every iteration is one scan through `detector`, which starts anew when the scans are
/// at their end (untimed, with the first two again). Adds counters: median, p99, wall [ms], memory [MB].
Measured timeDetector(::benchmark::State& state, Detector& detector, const Scans& scans);

/// Adds the counters median, p99, least and wall [ms].
void report(::benchmark::State& state, const Measured& measured);

/// Adds the counters `floor` [ms] and `of_floor`, and with a naive reference `naive` [ms] and `naive_over_this`.
void compare(::benchmark::State& state, const Measured& measured, const Measured& floor, const Measured* naive);

}  // namespace donex::benchmark
