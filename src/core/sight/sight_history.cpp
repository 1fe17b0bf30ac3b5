#include "core/sight/sight_history.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace donex {

void SightHistory::add(const Scan& scan, const std::vector<std::uint8_t>& is_echo) {
  const bool too_soon = !kept_.empty() && scan.stamp < kept_.back().stamp + 0.9 * spacing_;
  if (too_soon) return;
  forget(scan.stamp - length_);
  if (kept_.size() == SightView::kMostScans) forget(kept_[1].stamp);
  Kept next{scan.stamp, scan.odomFromSensor().inverse(), {}};
  if (!spares_.empty()) {
    next.image = std::move(spares_.back());
    spares_.pop_back();
  }
  if (!kept_.empty()) kept_.back().image.handOn(next.image);
  next.image.build(scan.echoes, is_echo, reading_);
  kept_.push_back(std::move(next));
}

void SightHistory::forget(double until) {
  const auto is_kept = [&](const Kept& kept) { return kept.stamp >= until; };
  const auto first = std::find_if(kept_.begin(), kept_.end(), is_kept);
  std::for_each(kept_.begin(), first, [&](Kept& kept) { spares_.push_back(std::move(kept.image)); });
  kept_.erase(kept_.begin(), first);
}

void SightHistory::reset() { forget(std::numeric_limits<double>::infinity()); }

SightView SightHistory::seenFrom(const Eigen::Isometry3d& odom_from_points) const {
  SightView view;
  for (auto kept = kept_.rbegin(); kept != kept_.rend(); ++kept) {
    view.kept_[view.count_++] = {kept->stamp, sightOf(*kept, odom_from_points)};
  }
  return view;
}

ScanSight SightHistory::newestSeenFrom(const Eigen::Isometry3d& odom_from_points) const {
  return kept_.empty() ? ScanSight() : sightOf(kept_.back(), odom_from_points);
}

SightView::Evidence SightView::ask(const Eigen::Vector3f& point, double since, int enough) const {
  Evidence evidence;
  for (std::size_t i = 0; i < count_ && kept_[i].stamp > since; ++i) {
    switch (kept_[i].sight.at(point)) {
      case SightImage::Sight::kFree: ++evidence.free; break;
      case SightImage::Sight::kSurface:
        ++evidence.surface;
        evidence.stale_surface += evidence.free > 0 ? 1 : 0;
        evidence.lasting_surface += kept_[0].stamp - kept_[i].stamp >= Evidence::kApproach ? 1 : 0;
        break;
      case SightImage::Sight::kHidden: ++evidence.hidden; break;
      case SightImage::Sight::kUnknown: break;
    }
    if (evidence.free >= enough) break;
  }
  return evidence;
}

double SightHistory::bytesFor(double length, double spacing, double echoes) {
  const double images = length / spacing + 2.0;  // both ends count, and one more is on its way out
  return images * SightImage::answerBytes() + SightImage::workspaceBytes(echoes);
}

std::size_t SightHistory::memoryBytes() const {
  std::size_t bytes = kept_.capacity() * sizeof(Kept);
  for (const Kept& kept : kept_) bytes += kept.image.memoryBytes();
  for (const SightImage& spare : spares_) bytes += spare.memoryBytes();
  return bytes;
}

}  // namespace donex
