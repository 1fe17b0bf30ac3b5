// The benchmarks, by what they show; main() registers them, so the report has this order.
#pragma once

namespace donex::benchmark {

void registerTable1();
void registerFullScans();
void registerScaling();
void registerHashMap();  ///< only where tsl::robin_map was found

}  // namespace donex::benchmark
