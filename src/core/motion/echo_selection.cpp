#include "core/motion/echo_selection.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace donex {

void EchoSelection::select(const std::vector<Eigen::Vector3f>& echoes) {
  echoes_ = echoes.size();
  const float nearest = nearestOf(echoes);
  const float least = nearest * nearest, most = options_.farthest * options_.farthest;
  usable_.clear();
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    const float range = echoes[i].squaredNorm();
    if (range >= least && range <= most) usable_.push_back(static_cast<std::uint32_t>(i));  // never with NaN
  }
  for_map_.clear();
  thinning_.pick(echoes, usable_, options_.map_edge, for_map_);
  for (const float edge : options_.source_edges) {
    to_register_.clear();
    thinning_.pick(echoes, for_map_, edge, to_register_);
    if (to_register_.size() >= options_.least_source) break;
  }
}

float EchoSelection::nearestOf(const std::vector<Eigen::Vector3f>& echoes) {
  constexpr std::size_t kEnough = 1000;  // ranges for a median
  const std::size_t stride = std::max<std::size_t>(1, echoes.size() / kEnough);
  ranges_.clear();
  for (std::size_t i = 0; i < echoes.size(); i += stride) {
    const float range = echoes[i].norm();
    if (std::isfinite(range) && range > 0.0F) ranges_.push_back(range);
  }
  if (ranges_.empty()) return options_.nearest_least;
  const auto middle = ranges_.begin() + static_cast<std::ptrdiff_t>(ranges_.size() / 2);
  std::nth_element(ranges_.begin(), middle, ranges_.end());
  return std::min(std::max(options_.nearest_share * *middle, options_.nearest_least), options_.nearest_most);
}

void EchoSelection::leaveOutMoving(const std::vector<std::uint8_t>& dynamic,
                                   std::vector<Eigen::Vector3f>& for_map) const {
  if (dynamic.size() != echoes_) throw std::invalid_argument("a label for each echo of the last scan is needed");
  std::size_t kept = 0;
  for (std::size_t i = 0; i < for_map.size(); ++i) {
    if (dynamic[for_map_[i]] == 0) for_map[kept++] = for_map[i];
  }
  for_map.resize(kept);
}

std::size_t EchoSelection::memoryBytes() const {
  return thinning_.memoryBytes() + ranges_.capacity() * sizeof(float) +
         (usable_.capacity() + for_map_.capacity() + to_register_.capacity()) * sizeof(std::uint32_t);
}

}  // namespace donex
