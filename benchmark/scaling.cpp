// How the cost grows: with the echoes, with smaller voxels, with the region, and what a second thread helps.
#include <string>

#include "references.h"
#include "register.h"

namespace donex::benchmark {
namespace {

struct Setting {
  Method method = Method::kDonex3d;
  std::size_t echoes = 160000;
  double voxel_size = 0.2;  ///< [m]
  double reach = 50.0;      ///< [m]
  int threads = 1;
};

Config configOf(const Setting& setting) {
  Config config = paperConfig(setting.method);
  config.voxel_size = setting.voxel_size;
  config.region = {-setting.reach, setting.reach, -setting.reach, setting.reach, -4.0, 6.0};
  config.threads = setting.threads;
  return config;
}

void run(::benchmark::State& state, const Setting& setting) {
  const Config config = configOf(setting);
  const Scans& scans = scansOf(setting.echoes);
  const auto detector = makeDetector(config);
  compare(state, timeDetector(state, *detector, scans), floorOf(setting.method, config, scans), nullptr);
}

void add(const std::string& group, const std::string& value, const Setting& setting) {
  const std::string name = nameOf(setting.method);
  ::benchmark::RegisterBenchmark((group + "/" + name + "/" + value).c_str(), run, setting)
      ->UseManualTime()
      ->Unit(::benchmark::kMillisecond);
}

}  // namespace

void registerScaling() {
  for (const Method method : {Method::kDonex2d, Method::kDonex3d}) {
    Setting setting;
    setting.method = method;
    for (const std::size_t echoes : {10000, 30000, 100000, 300000, 500000, 1000000}) {
      setting.echoes = echoes;
      add("echoes", std::to_string(echoes), setting);
    }
    setting.echoes = Setting().echoes;
    setting.reach = 30.0;  // where voxels of 0.05 m fit the default memory limit
    for (const char* size : {"0.5", "0.4", "0.2", "0.1", "0.05"}) {
      setting.voxel_size = std::stod(size);
      add("voxel_size", size, setting);
    }
    setting.voxel_size = Setting().voxel_size;
    setting.reach = Setting().reach;
    for (const char* reach : {"25", "50", "75", "100"}) {
      setting.reach = std::stod(reach);
      add("reach", reach, setting);
    }
    setting.reach = Setting().reach;
    setting.echoes = 500000;
    for (const char* threads : {"1", "2"}) {
      setting.threads = std::stoi(threads);
      add("threads", threads, setting);
    }
  }
}

}  // namespace donex::benchmark
