#include "donex/core/sight_history.h"

namespace donex {

void SightHistory::add(const Scan& scan, const std::vector<std::uint8_t>& is_echo) {
  const bool too_soon = !kept_.empty() && scan.stamp < kept_.back().stamp + 0.9 * spacing_;
  if (too_soon) return;
  Kept next;
  while (!kept_.empty() && kept_.front().stamp < scan.stamp - length_) {
    next = std::move(kept_.front());  // its image's storage is used again
    kept_.pop_front();
  }
  next.stamp = scan.stamp;
  next.sensor_from_odom = scan.odomFromSensor().inverse();
  if (!kept_.empty()) next.image.takeWorkspace(kept_.back().image);
  if (!kept_.empty()) next.image.takeGapsFrom(kept_.back().image);
  next.image.build(scan.echoes, is_echo, reading_);
  kept_.push_back(std::move(next));
}

void SightHistory::askFrom(const Eigen::Isometry3d& odom_from_asked) {
  for (Kept& kept : kept_) kept.sensor_from_asked = (kept.sensor_from_odom * odom_from_asked).cast<float>();
}

SightHistory::Evidence SightHistory::ask(const Eigen::Vector3f& point, double since, int enough) const {
  Evidence evidence;
  for (auto kept = kept_.rbegin(); kept != kept_.rend() && kept->stamp > since; ++kept) {
    switch (kept->image.at(kept->sensor_from_asked * point, margin_)) {
      case SightImage::Sight::kFree: ++evidence.free; break;
      case SightImage::Sight::kSurface: ++evidence.surface; break;
      case SightImage::Sight::kHidden: ++evidence.hidden; break;
      case SightImage::Sight::kUnknown: break;
    }
    if (evidence.free >= enough) break;
  }
  return evidence;
}

SightImage::Sight SightHistory::askNewest(const Eigen::Vector3f& point, float margin) const {
  if (kept_.empty()) return SightImage::Sight::kUnknown;
  return kept_.back().image.at(kept_.back().sensor_from_asked * point, margin);
}

SightImage::Sight SightHistory::askThroughGaps(const Eigen::Vector3f& point, float margin) const {
  if (kept_.empty()) return SightImage::Sight::kUnknown;
  return kept_.back().image.throughGaps(kept_.back().sensor_from_asked * point, margin);
}

std::size_t SightHistory::memoryBytes() const {
  std::size_t bytes = kept_.size() * sizeof(Kept);
  for (const Kept& kept : kept_) bytes += kept.image.memoryBytes();
  return bytes;
}

}  // namespace donex
