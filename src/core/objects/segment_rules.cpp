#include "core/objects/segment_rules.h"

#include <algorithm>

namespace donex {

bool SegmentRules::isTooLong(const Segment& segment) const { return segment.extent().maxCoeff() > options_.longest; }

bool SegmentRules::isMostlySettled(const Segment& segment) {
  return 2 * static_cast<std::size_t>(segment.settled_echoes) > segment.echoes.size();
}

bool SegmentRules::isNew(const Segment& segment) const {
  const double fresh = segment.new_echoes, all = static_cast<double>(segment.echoes.size());
  const double least = options_.least_new_share * all;
  const bool enough = segment.new_echoes >= config_.min_echoes && !isTooLong(segment);
  const bool outweighs = fresh > config_.new_share * (fresh + segment.settled_echoes + segment.surface_echoes);
  const bool surely = segment.surely_new_echoes >= std::max<double>(config_.min_echoes, least);
  const bool by_share = fresh > least && (surely || fresh >= options_.unsure_new_share * all);
  return enough && outweighs && by_share && !fitsBetweenBeams(segment);
}

bool SegmentRules::isFresh(const Segment& segment) const {
  return segment.freshEchoes() >= std::max<double>(config_.min_echoes, options_.least_fresh_share * segment.new_echoes);
}

bool SegmentRules::fitsBetweenBeams(const Segment& segment) const {
  return segment.extent().z() < options_.low && segment.coarsely_new_echoes > options_.most_coarse * segment.new_echoes;
}

bool SegmentRules::isNewOverhead(const Segment& segment, const Eigen::Vector3d& sensor) const {
  const double distance = (segment.center() - sensor).norm();
  const double thickness = segment.highest_new - segment.lowest_new;
  return segment.lowest_new > options_.overhead && thickness < options_.thin_angle * distance;
}

bool SegmentRules::isUpright(const Segment& segment) const {
  return segment.extent().z() > options_.upright_ratio * segment.extent().head<2>().maxCoeff();
}

bool SegmentRules::isNarrow(const Segment& segment) const {
  return segment.extent().head<2>().maxCoeff() < options_.narrow;
}

bool SegmentRules::isThin(const Segment& segment, const Eigen::Vector3d& sensor) const {
  const double distance = (segment.center() - sensor).norm();
  return distance < options_.thin_reach && segment.extent().z() < options_.thin_angle * distance;
}

bool SegmentRules::hasRear(const Segment& segment) const {
  const Eigen::Vector3d extent = segment.extent();
  const bool is_rail = extent.z() < options_.rail_height && extent.head<2>().maxCoeff() > options_.rail_length;
  const bool is_one_beam_high_up = extent.z() < options_.one_beam && segment.lowest > options_.high;
  return !is_rail && !is_one_beam_high_up;
}

bool SegmentRules::isPole(const Segment& segment) const {
  const Eigen::Vector3d extent = segment.extent();
  return extent.head<2>().maxCoeff() < options_.slim && extent.z() > options_.low;
}

bool SegmentRules::areAlike(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
  const Eigen::Array3d unlike = (options_.other_view_share * a.cwiseMax(b)).array() + options_.frayed_ends;
  return ((a - b).array().abs() <= unlike).all();
}

bool SegmentRules::isLong(const Eigen::Vector3d& extent) const {
  return extent.head<2>().maxCoeff() > options_.long_extent;
}

bool SegmentRules::looksLike(const Segment& segment, const Prediction& object) const {
  const double distance = (segment.center() - object.center).norm();
  return distance <= options_.followed_distance && areAlike(object.extent, segment.extent());
}

bool SegmentRules::holds(const Segment& segment, const Prediction& object) const {
  const bool inside = ((object.center - segment.low).array() > -options_.prediction_rim).all() &&
                      ((segment.high - object.center).array() > -options_.prediction_rim).all();
  return inside && !looksLike(segment, object);
}

}  // namespace donex
