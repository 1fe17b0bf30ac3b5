#include "evaluation/map_score.h"

#include <cmath>

#include "evaluation/ratio.h"

namespace donex {

void MapScore::add(const Eigen::Vector3d& point, bool is_moving, bool is_kept) {
  const Index3 index = (point / voxel_size_).array().floor().cast<int>();
  Voxel& voxel = voxels_[keyOf(index)];
  ++(is_moving ? voxel.moving : voxel.fixed);
  if (is_kept) ++(is_moving ? voxel.kept_moving : voxel.kept_fixed);
}

MapScore::Rates MapScore::rates() const {
  Rates rates;
  std::uint64_t preserved = 0, rejected = 0, kept = 0, left_out = 0;
  for (const auto& [key, voxel] : voxels_) {
    const bool is_static = voxel.fixed > voxel.moving;
    ++(is_static ? rates.static_voxels : rates.dynamic_voxels);
    preserved += is_static && voxel.kept_fixed > 0 ? 1U : 0U;
    rejected += !is_static && voxel.kept_moving == 0 ? 1U : 0U;
    rates.static_echoes += voxel.fixed;
    rates.dynamic_echoes += voxel.moving;
    kept += voxel.kept_fixed;
    left_out += voxel.moving - voxel.kept_moving;
  }
  rates.preservation = ratio(preserved, rates.static_voxels);
  rates.rejection = ratio(rejected, rates.dynamic_voxels);
  rates.f1 = 2.0 * rates.preservation * rates.rejection / (rates.preservation + rates.rejection);
  rates.static_accuracy = ratio(kept, rates.static_echoes);
  rates.dynamic_accuracy = ratio(left_out, rates.dynamic_echoes);
  rates.associated = std::sqrt(rates.static_accuracy * rates.dynamic_accuracy);
  return rates;
}

}  // namespace donex
