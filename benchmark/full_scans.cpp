// The default configuration, objects and all: on whole turns of a sensor of about 120,000 echoes, and of far more.
#include <functional>
#include <string>

#include "references.h"
#include "register.h"

namespace donex::benchmark {
namespace {

/// Builds the scans only when they are wanted.
using Drive = std::function<const Scans&()>;

void run(::benchmark::State& state, Method method, const Drive& drive) {
  Config config;
  config.method = method;
  const Scans& scans = drive();
  const auto detector = makeDetector(config);
  compare(state, timeDetector(state, *detector, scans), floorOf(method, config, scans), nullptr);
}

void add(const std::string& name, Method method, const Drive& drive, int iterations) {
  ::benchmark::RegisterBenchmark(("default/" + nameOf(method) + "/" + name).c_str(), run, method, drive)
      ->UseManualTime()
      ->Unit(::benchmark::kMillisecond)
      ->Iterations(iterations);
}

}  // namespace

void registerFullScans() {
  constexpr int kTwice = 116;  // through the drive: a p99 needs many
  for (const std::string scene : {"street", "intersection"}) {
    const auto drive = [scene]() -> const Scans& { return fullScans(scene, 64, 60); };
    for (const Method method : {Method::kDonex2d, Method::kDonex3d}) add(scene, method, drive, kTwice);
  }
  constexpr int kSome = 40;
  add(
      "1000000", Method::kDonex2d, []() -> const Scans& { return scansOf(1000000); }, kSome);
  add(
      "500000", Method::kDonex3d, []() -> const Scans& { return scansOf(500000); }, kSome);
}

}  // namespace donex::benchmark
