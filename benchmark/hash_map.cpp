// The paper's future work asks whether hash maps help: one pass of hits over the echoes, with the voxels' bricks in a
// dense array, and in a hash map (tsl::robin_map, std::unordered_map).
#include <string>
#include <unordered_map>

#include <tsl/robin_map.h>

#include "core/grid/brick_layout.h"
#include "references.h"
#include "register.h"

namespace donex::benchmark {
namespace {

Config configOf(double voxel_size) {
  Config config = paperConfig(Method::kDonex3d);
  config.voxel_size = voxel_size;
  return config;
}

/// The same for all: places the echoes, and shows `brick_at(slot)` a hit's brick; its bits gather what was hit.
template <class Bricks>
void hit(const Scan& scan, GridWindow& window, BrickLayout& layout, Bricks&& brick_at) {
  window.moveTo(scan.odom_from_base);
  layout.scrollTo(window.minIndex());
  BlockSlots at;
  forEachBlock(window.placementOf(scan), scan.echoes, 0, blocksOf(scan.echoes.size()),
               [&](std::size_t, const EchoBlock& block) {
                 layout.locate(block, at);
                 for (int i = 0; i < block.count; ++i) brick_at(at.slot[i]) |= std::uint64_t{1} << at.bit[i];
               });
}

Measured timeDense(const Config& config, const Scans& scans) {
  GridWindow window(config);
  BrickLayout layout(window.extent());
  std::vector<std::uint64_t> bricks(layout.slots() + 1);
  return measure(scans, 3, [&](const Scan& scan) {
    hit(scan, window, layout, [&](std::uint32_t slot) -> std::uint64_t& { return bricks[slot]; });
  });
}

template <class Map>
Measured timeMap(const Config& config, const Scans& scans) {
  GridWindow window(config);
  BrickLayout layout(window.extent());
  Map bricks;
  return measure(scans, 3, [&](const Scan& scan) {
    hit(scan, window, layout, [&](std::uint32_t slot) -> std::uint64_t& { return bricks[slot]; });
  });
}

using Timed = Measured (*)(const Config&, const Scans&);

void run(::benchmark::State& state, Timed timed, double voxel_size) {
  const Config config = configOf(voxel_size);
  const Scans& scans = scansOf(160000);
  Measured measured;
  for (auto _ : state) {
    measured = timed(config, scans);
    state.SetIterationTime(1e-3 * measured.wall);
  }
  report(state, measured);
  compare(state, measured, floorOf(Method::kDonex3d, config, scans), nullptr);
}

}  // namespace

void registerHashMap() {
  const std::pair<const char*, Timed> kinds[] = {
      {"dense", timeDense},
      {"robin_map", timeMap<tsl::robin_map<std::uint32_t, std::uint64_t>>},
      {"unordered_map", timeMap<std::unordered_map<std::uint32_t, std::uint64_t>>}};
  for (const auto& [name, timed] : kinds) {
    for (const char* voxel_size : {"0.2", "0.1"}) {
      const std::string full = std::string("hits/") + name + "/" + voxel_size;
      ::benchmark::RegisterBenchmark(full.c_str(), run, timed, std::stod(voxel_size))
          ->UseManualTime()
          ->Unit(::benchmark::kMillisecond)
          ->Iterations(1);
    }
  }
}

}  // namespace donex::benchmark
