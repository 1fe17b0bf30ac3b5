// The benchmarks, by what they show; main() registers them, so the report has this order.
#pragma once

namespace donex::benchmark {

void registerTable1();
void registerFullScans();
void registerScaling();

}  // namespace donex::benchmark
