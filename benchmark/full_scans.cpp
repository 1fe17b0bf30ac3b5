// The default configuration, objects and all, on whole turns of a sensor of about 120,000 echoes.
#include <string>

#include "references.h"
#include "register.h"

namespace donex::benchmark {
namespace {

void run(::benchmark::State& state, const std::string& scene, Method method) {
  Config config;
  config.method = method;
  const Scans& scans = fullScans(scene, 64, 60);
  const auto detector = makeDetector(config);
  compare(state, timeDetector(state, *detector, scans), floorOf(method, config, scans), nullptr);
}

}  // namespace

void registerFullScans() {
  for (const char* scene : {"street", "intersection"}) {
    for (const Method method : {Method::kDonex2d, Method::kDonex3d}) {
      const std::string name = "default/" + nameOf(method) + "/" + scene;
      ::benchmark::RegisterBenchmark(name.c_str(), run, std::string(scene), method)
          ->UseManualTime()
          ->Unit(::benchmark::kMillisecond)
          ->Iterations(116);  // twice the drive: a p99 needs many
    }
  }
}

}  // namespace donex::benchmark
