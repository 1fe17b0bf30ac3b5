#include "core/objects/segment.h"

#include <limits>

namespace donex {
void describeEchoes(const JudgedScan& scan, Segment& segment) {
  segment.low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  segment.high = -segment.low;
  segment.new_echoes = segment.surely_new_echoes = segment.surface_echoes = segment.settled_echoes = 0;
  segment.lowest = segment.lowest_new = std::numeric_limits<float>::infinity();
  segment.highest_new = -segment.lowest_new;
  for (const std::uint32_t echo : segment.echoes) {
    const Place place = scan.places[echo];
    const float height = scan.has_ground ? scan.heights[echo] : 0.0F;
    segment.lowest = std::min(segment.lowest, height);
    if (isNewPlace(place)) {
      ++segment.new_echoes;
      segment.lowest_new = std::min(segment.lowest_new, height);
      segment.highest_new = std::max(segment.highest_new, height);
    }
    segment.surely_new_echoes += place == Place::kSurelyNew ? 1 : 0;
    segment.surface_echoes += place == Place::kAtSurface ? 1 : 0;
    segment.settled_echoes += place == Place::kSettled ? 1 : 0;
    const Eigen::Vector3d in_odom = scan.odom_from_points * scan.points[echo].cast<double>();
    segment.low = segment.low.cwiseMin(in_odom);
    segment.high = segment.high.cwiseMax(in_odom);
  }
}

}  // namespace donex
