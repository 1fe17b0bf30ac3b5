#include "scans.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "simulation/simulator.h"

namespace donex::benchmark {
namespace {

constexpr std::size_t kScans = 12;
constexpr double kAzimuthStep = 0.0031;  // [rad] a little less than the simulated sensor's

/// Every `thin`-th echo, `copies` times side by side.
Scan resampled(const Scan& scan, std::size_t thin, std::size_t copies) {
  Scan result = scan;
  result.echoes.clear();
  for (std::size_t i = 0; i < scan.echoes.size(); i += thin) {
    for (std::size_t copy = 0; copy < copies; ++copy) {
      const auto turn = static_cast<float>(kAzimuthStep * static_cast<double>(copy) / static_cast<double>(copies));
      result.echoes.push_back(Eigen::AngleAxisf(turn, Eigen::Vector3f::UnitZ()) * scan.echoes[i]);
    }
  }
  return result;
}

Scan inFront(const Scan& scan, std::size_t echoes) {
  Scan result = scan;
  result.echoes.clear();
  for (const float side : {1.0F, -1.0F}) {
    for (const Eigen::Vector3f& echo : scan.echoes) {
      const Eigen::Vector3f turned(side * echo.x(), side * echo.y(), echo.z());
      const bool in_front = turned.x() >= 0.0F && turned.x() < 75.0F && std::abs(turned.y()) < 25.0F;
      if (in_front && result.echoes.size() < echoes) result.echoes.push_back(turned);
    }
  }
  return result;
}

}  // namespace

const Scans& fullScans(const std::string& scene, int beams, std::size_t count) {
  static std::map<std::tuple<std::string, int, std::size_t>, Scans> built;
  const auto [place, is_new] = built.try_emplace({scene, beams, count});
  if (!is_new) return place->second;
  simulation::SimulatorOptions options;
  options.beams = beams;
  simulation::Simulator simulator(scene, options);
  simulation::SimulatedScan simulated;
  while (place->second.size() < count && simulator.next(simulated)) place->second.push_back(simulated.coreScan());
  return place->second;
}

const Scans& scansInFront(std::size_t echoes) {
  static std::map<std::size_t, Scans> built;
  const auto [place, is_new] = built.try_emplace(echoes);
  if (!is_new) return place->second;
  for (const Scan& scan : fullScans("street", 128, kScans)) place->second.push_back(inFront(scan, echoes));
  return place->second;
}

const Scans& scansOf(std::size_t echoes) {
  static std::map<std::size_t, Scans> built;
  const auto [place, is_new] = built.try_emplace(echoes);
  if (!is_new) return place->second;
  for (const Scan& scan : fullScans("street", 128, kScans)) {
    const std::size_t thin = std::max<std::size_t>(1, scan.echoes.size() / echoes);
    const std::size_t copies = (echoes * thin + scan.echoes.size() - 1) / scan.echoes.size();
    place->second.push_back(resampled(scan, thin, copies));
    place->second.back().echoes.resize(std::min(echoes, place->second.back().echoes.size()));
  }
  return place->second;
}

}  // namespace donex::benchmark
