// Times a scan of both grids, by the paper's rule and as by default, beside the floor and the naive traversal, all in
// one run (Google Benchmark's options apply: --benchmark_filter, --benchmark_out). scripts/benchmark makes tables and
// plots of what it writes.
#include <benchmark/benchmark.h>

#include "register.h"

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  donex::benchmark::registerTable1();
  donex::benchmark::registerFullScans();
  donex::benchmark::registerScaling();
#ifdef DONEX_HAS_ROBIN_MAP
  donex::benchmark::registerHashMap();
#endif
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
