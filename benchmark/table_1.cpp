// The paper's Table 1 setting: time a scan of the paper's rule, 2D and 3D, beside two references in the same run:
// one pass that touches every echo's voxel, and the naive traversal of every line of sight.
// Usage: donex_table_1 [echoes a scan]     (default 160000, from a simulated 128-beam sensor in a street)
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>

#include "donex/core/brick_mask.h"
#include "donex/core/detector.h"
#include "donex/core/line_of_sight.h"
#include "donex/simulation/simulator.h"
#include "support/configs.h"

namespace {

using donex::Config;
using donex::Scan;

constexpr int kScans = 12;

double medianMilliseconds(const std::vector<Scan>& scans, const std::function<void(const Scan&)>& work) {
  std::vector<double> times;
  for (const Scan& scan : scans) {
    const auto start = std::chrono::steady_clock::now();
    work(scan);
    times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  std::sort(times.begin() + 2, times.end());  // the first two warm up
  return times[2 + (times.size() - 2) / 2];
}

/// Scans with `echoes` echoes in x 0..75 m, y +-25 m: a turned copy fills what one turn of the sensor leaves open.
std::vector<Scan> scansInFront(std::size_t echoes) {
  donex::simulation::SimulatorOptions options;
  options.beams = 128;
  donex::simulation::Simulator simulator("street", options);
  donex::simulation::SimulatedScan simulated;
  std::vector<Scan> scans;
  while (scans.size() < kScans && simulator.next(simulated)) {
    Scan scan = simulated.coreScan();
    const std::vector<Eigen::Vector3f> all = scan.echoes;
    scan.echoes.clear();
    for (const float side : {1.0F, -1.0F}) {
      for (const Eigen::Vector3f& echo : all) {
        const Eigen::Vector3f turned(side * echo.x(), side * echo.y(), echo.z());
        const bool in_front = turned.x() >= 0.0F && turned.x() < 75.0F && std::abs(turned.y()) < 25.0F;
        if (in_front && scan.echoes.size() < echoes) scan.echoes.push_back(turned);
      }
    }
    scans.push_back(scan);
  }
  return scans;
}

Config tableConfig(donex::Method method, double voxel_size) {
  Config config = donex::testing::paperConfig(method);
  config.voxel_size = voxel_size;
  config.region = {0.0, 75.0, -25.0, 25.0, -4.0, 6.0};
  return config;
}

void timeRow(const std::vector<Scan>& scans, double voxel_size) {
  donex::GridWindow window(tableConfig(donex::Method::kDonex3d, voxel_size));
  donex::BrickLayout layout(window.extent());
  donex::BrickMask touched(layout.slots());
  donex::GridScan in_grid;
  const double floor = medianMilliseconds(scans, [&](const Scan& scan) {
    window.moveTo(scan.odom_from_base);
    window.enter(scan, in_grid);
    for (std::size_t i = 0; i < in_grid.echoes.size(); ++i) {
      if (in_grid.inside[i] != 0) touched.set(layout.locate(donex::voxelOf(in_grid.echoes[i])));
    }
  });
  const double naive = medianMilliseconds(scans, [&](const Scan& scan) {
    window.moveTo(scan.odom_from_base);
    window.enter(scan, in_grid);
    for (const Eigen::Vector3f& echo : in_grid.echoes) {
      for (const donex::Index3& voxel : donex::LineOfSight(in_grid.origin, echo)) {
        if (window.contains(voxel)) touched.set(layout.locate(voxel));
      }
    }
  });
  const auto method = [&](donex::Method name) {
    const auto detector = donex::makeDetector(tableConfig(name, voxel_size));
    donex::EchoLabels labels;
    return medianMilliseconds(scans, [&](const Scan& scan) { detector->process(scan, labels); });
  };
  const double in_2d = method(donex::Method::kDonex2d), in_3d = method(donex::Method::kDonex3d);
  std::printf("%6.2f %10.2f %10.1f %10.2f (%5.1f x) %10.2f (%5.1f x, naive / 3D %6.1f)\n", voxel_size, floor, naive,
              in_2d, in_2d / floor, in_3d, in_3d / floor, naive / in_3d);
}

}  // namespace

int main(int argc, char** argv) {
  const long wanted = argc > 1 ? std::atol(argv[1]) : 160000;
  if (wanted < 1) {
    std::fprintf(stderr, "usage: donex_table_1 [echoes a scan]\n");
    return 2;
  }
  const std::vector<Scan> scans = scansInFront(static_cast<std::size_t>(wanted));
  std::printf("%zu echoes a scan in x 0..75 m, y +-25 m; milliseconds, median of %d scans; one core\n",
              scans.back().echoes.size(), kScans - 2);
  std::printf(" voxel      touch      naive         2D (of touch)          3D (of touch)\n");
  for (const double voxel_size : {0.3, 0.15, 0.1}) timeRow(scans, voxel_size);
  return 0;
}
