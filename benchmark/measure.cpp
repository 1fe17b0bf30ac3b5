#include "measure.h"

#include "core/timing.h"

namespace donex::benchmark {
namespace {

constexpr std::size_t kWarmUp = 2;

struct Times {
  std::vector<double> cpu, wall;  ///< one per scan [ms]

  template <class Work>
  void add(Work&& work) {
    const double wall_start = wallTime(), cpu_start = cpuTime();
    work();
    cpu.push_back(1e3 * (cpuTime() - cpu_start));
    wall.push_back(1e3 * (wallTime() - wall_start));
  }
  Measured summary() const {
    return {quantile(cpu, 0.5), quantile(cpu, 0.99), quantile(cpu, 0.0), quantile(wall, 0.5)};
  }
};

}  // namespace

Measured measure(const Scans& scans, int rounds, const std::function<void(const Scan&)>& work) {
  Times times;
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < kWarmUp; ++i) work(scans[i]);
    for (std::size_t i = kWarmUp; i < scans.size(); ++i) times.add([&] { work(scans[i]); });
  }
  return times.summary();
}

void report(::benchmark::State& state, const Measured& measured) {
  state.counters["median_ms"] = measured.median;
  state.counters["p99_ms"] = measured.p99;
  state.counters["least_ms"] = measured.least;
  state.counters["wall_ms"] = measured.wall;
}

Measured timeDetector(::benchmark::State& state, Detector& detector, const Scans& scans) {
  Times times;
  EchoLabels labels;
  std::size_t next = scans.size();
  for (auto _ : state) {
    if (next == scans.size()) {
      detector.reset();
      for (next = 0; next < kWarmUp; ++next) detector.process(scans[next], labels);
    }
    times.add([&] { detector.process(scans[next], labels); });
    ++next;
    state.SetIterationTime(1e-3 * times.wall.back());
  }
  const Measured measured = times.summary();
  report(state, measured);
  state.counters["memory_MB"] = 1e-6 * static_cast<double>(detector.memoryBytes());
  state.counters["echoes"] = static_cast<double>(scans.back().echoes.size());
  return measured;
}

void compare(::benchmark::State& state, const Measured& measured, const Measured& floor, const Measured* naive) {
  state.counters["floor_ms"] = floor.median;
  state.counters["least_of_floor"] = measured.least / floor.least;
  state.counters["of_floor"] = measured.median / floor.median;
  if (naive == nullptr) return;
  state.counters["naive_ms"] = naive->median;
  state.counters["least_naive_over_this"] = naive->least / measured.least;
  state.counters["naive_over_this"] = naive->median / measured.median;
}

}  // namespace donex::benchmark
