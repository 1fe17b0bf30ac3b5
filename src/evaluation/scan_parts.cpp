#include "evaluation/scan_parts.h"

#include <stdexcept>
#include <string>

#include "core/sector.h"

namespace donex {

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
