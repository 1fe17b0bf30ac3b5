#include "evaluation/object_speeds.h"

#include <algorithm>
#include <cmath>

namespace donex {

ObjectSpeeds::ObjectSpeeds(const SequenceReader& sequence, std::size_t scans) {
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    const bool is_needed = i < scans || (scans > 0 && sequence.stamp(i) < sequence.stamp(scans - 1) + kReach);
    if (!is_needed) return;
    if (!sequence.hasLabels(i)) continue;
    add(sequence.stamp(i), sequence.pose(i), sequence.scan(i).echoes, sequence.labels(i));
  }
}

void ObjectSpeeds::add(double stamp, const Pose& odom_from_sensor, const std::vector<Eigen::Vector3f>& echoes,
                       const std::vector<std::uint32_t>& labels) {
  std::map<std::uint32_t, std::pair<Eigen::Vector3d, double>> sums;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (instanceOfLabel(labels[i]) == 0 || !echoes[i].allFinite()) continue;
    auto& [sum, count] = sums.try_emplace(labels[i], Eigen::Vector3d::Zero(), 0.0).first->second;
    sum += echoes[i].cast<double>();
    count += 1.0;
  }
  const Eigen::Isometry3d odom = odom_from_sensor.isometry();
  for (const auto& [label, sum] : sums) {
    centers_[label].emplace_back(stamp, odom * Eigen::Vector3d(sum.first / sum.second));
  }
}

std::optional<double> ObjectSpeeds::at(std::uint32_t label, double stamp) const {
  const auto found = centers_.find(label);
  if (found == centers_.end()) return std::nullopt;
  const auto& centers = found->second;
  const auto earlier = [](const auto& center, double time) { return center.first < time; };
  const auto first = std::lower_bound(centers.begin(), centers.end(), stamp - kReach, earlier);
  const auto end = std::lower_bound(centers.begin(), centers.end(), stamp + kReach, earlier);
  const bool is_seen = std::any_of(first, end, [&](const auto& center) { return center.first == stamp; });
  if (!is_seen || end - first < 2) return std::nullopt;
  const auto last = std::prev(end);
  return (last->second - first->second).norm() / (last->first - first->first);
}

}  // namespace donex
