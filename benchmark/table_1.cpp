// The paper's Table 1: x 0..75 m, y +-25 m, about 160,000 echoes, voxels of 0.3, 0.15 and 0.1 m, 2D and 3D.
#include <string>

#include "references.h"
#include "register.h"

namespace donex::benchmark {
namespace {

constexpr std::size_t kEchoes = 160000;

Config tableConfig(Method method, double voxel_size) {
  Config config = paperConfig(method);
  config.voxel_size = voxel_size;
  config.region = {0.0, 75.0, -25.0, 25.0, -4.0, 6.0};
  return config;
}

void run(::benchmark::State& state, Method method, double voxel_size) {
  const Config config = tableConfig(method, voxel_size);
  const Scans& scans = scansInFront(kEchoes);
  const auto detector = makeDetector(config);
  const Measured measured = timeDetector(state, *detector, scans);
  const Measured naive = naiveOf(tableConfig(Method::kDonex3d, voxel_size), scans);
  compare(state, measured, floorOf(method, config, scans), &naive);
}

}  // namespace

void registerTable1() {
  for (const Method method : {Method::kDonex2d, Method::kDonex3d}) {
    for (const char* voxel_size : {"0.3", "0.15", "0.1"}) {
      const std::string name = nameOf(method);
      ::benchmark::RegisterBenchmark(("table_1/" + name + "/" + voxel_size).c_str(), run, method, std::stod(voxel_size))
          ->UseManualTime()
          ->Unit(::benchmark::kMillisecond);
    }
  }
}

}  // namespace donex::benchmark
