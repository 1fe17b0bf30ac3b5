// The default configuration, objects and all: on whole turns of a sensor of about 120,000 echoes, and of far more.
#include <functional>
#include <string>

#include "references.h"
#include "register.h"

namespace donex::benchmark {
namespace {

/// Builds the scans only when they are wanted.
using Drive = std::function<const Scans&()>;

void run(::benchmark::State& state, Method method, int threads, const Drive& drive) {
  Config config;
  config.method = method;
  config.threads = threads;
  const Scans& scans = drive();
  const auto detector = makeDetector(config);
  compare(state, timeDetector(state, *detector, scans), floorOf(method, config, scans), nullptr);
}

void add(const std::string& group, const std::string& name, Method method, int threads, const Drive& drive,
         int iterations) {
  ::benchmark::RegisterBenchmark((group + "/" + nameOf(method) + "/" + name).c_str(), run, method, threads, drive)
      ->UseManualTime()
      ->Unit(::benchmark::kMillisecond)
      ->Iterations(iterations);
}

}  // namespace

void registerFullScans() {
  constexpr int kTwice = 116;  // through the drive: a p99 needs many
  for (const std::string scene : {"street", "intersection"}) {
    const auto drive = [scene]() -> const Scans& { return fullScans(scene, 64, 60); };
    for (const Method method : {Method::kDonex2d, Method::kDonex3d}) add("default", scene, method, 1, drive, kTwice);
  }
  const auto street = []() -> const Scans& { return fullScans("street", 64, 60); };  // about 150,000 echoes a scan
  for (const Method method : {Method::kDonex2d, Method::kDonex3d}) {
    for (const int threads : {1, 2}) {
      add("default_threads", std::to_string(threads), method, threads, street, kTwice);
    }
  }
  constexpr int kSome = 40;
  add(
      "default", "1000000", Method::kDonex2d, 1, []() -> const Scans& { return scansOf(1000000); }, kSome);
  add(
      "default", "500000", Method::kDonex3d, 1, []() -> const Scans& { return scansOf(500000); }, kSome);
}

}  // namespace donex::benchmark
