#include "core/objects/segment.h"

#include <limits>

namespace donex {
void describeEchoes(const JudgedScan& scan, Segment& segment) {
  Eigen::Array3f low = Eigen::Array3f::Constant(std::numeric_limits<float>::infinity()), high = -low;
  segment.new_echoes = segment.surely_new_echoes = segment.coarsely_new_echoes = segment.lingering_echoes = 0;
  segment.surface_echoes = segment.settled_echoes = 0;
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
    segment.surely_new_echoes += is(place, Place::kSurelyNew) ? 1 : 0;
    segment.coarsely_new_echoes += is(place, Place::kCoarselyNew) ? 1 : 0;
    segment.lingering_echoes += is(place, Place::kLingering) ? 1 : 0;
    segment.surface_echoes += place == Place::kAtSurface ? 1 : 0;
    segment.settled_echoes += place == Place::kSettled ? 1 : 0;
    low = low.min(scan.points[echo].array());
    high = high.max(scan.points[echo].array());
  }
  // Points are only moved, not turned, and rounding keeps their order: the outermost stay so, to the last bit.
  segment.low = scan.odom_from_points * low.matrix().cast<double>();
  segment.high = scan.odom_from_points * high.matrix().cast<double>();
}

}  // namespace donex
