#include "evaluation/scan_parts.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/pi.h"

namespace donex {
namespace {

std::size_t sectorOf(const Eigen::Vector3f& echo, std::size_t sectors) {
  const float azimuth = std::atan2(echo.y(), echo.x());
  if (!std::isfinite(azimuth)) return 0;
  const float turn = azimuth / (2.0F * kPiF);
  const float share = turn < 0.0F ? turn + 1.0F : turn;
  return std::min(static_cast<std::size_t>(share * static_cast<float>(sectors)), sectors - 1);
}

}  // namespace

ScanParts::ScanParts(std::size_t parts) {
  if (parts < 1 || parts > kMost) {
    throw std::invalid_argument("a scan has 1 to " + std::to_string(kMost) + " parts, not " + std::to_string(parts));
  }
  parts_.resize(parts);
  echoes_of_part_.resize(parts);
}

void ScanParts::cut(const Scan& scan, double duration) {
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    parts_[k].stamp = scan.stamp + duration * static_cast<double>(k) / static_cast<double>(parts_.size());
    parts_[k].base_from_sensor = scan.base_from_sensor;
    parts_[k].odom_from_base = scan.odom_from_base;
    parts_[k].echoes.clear();
    echoes_of_part_[k].clear();
  }
  for (std::size_t i = 0; i < scan.echoes.size(); ++i) {
    const std::size_t sector = sectorOf(scan.echoes[i], parts_.size());
    parts_[sector].echoes.push_back(scan.echoes[i]);
    echoes_of_part_[sector].push_back(static_cast<std::uint32_t>(i));
  }
}

void ScanParts::putBack(std::size_t part, const EchoLabels& labels, EchoLabels& whole) const {
  const std::vector<std::uint32_t>& echoes = echoes_of_part_.at(part);
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    whole.dynamic[echoes[i]] = labels.dynamic[i];
    whole.observed[echoes[i]] = labels.observed[i];
  }
}

}  // namespace donex
