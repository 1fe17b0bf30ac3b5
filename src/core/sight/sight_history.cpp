#include "core/sight/sight_history.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace donex {
namespace {

constexpr double kSamePose = 1e-5;  // as isApprox has it: a part needs no new pixels

}  // namespace

TurnPart SightHistory::arrive(const Scan& scan, const std::vector<std::uint8_t>& is_echo, const Workers& workers) {
  pixels_.project(scan.echoes, is_echo, workers);
  newest_mounting_ = scan.base_from_sensor;
  const TurnPart part = turns_.arrive(scan, pixels_, workers);
  if (part == TurnPart::kContinuing) return part;
  turn_began_ = scan.stamp;
  keeps_turn_ = kept_.empty() || scan.stamp >= kept_.back().stamp + 0.9 * spacing_;
  if (keeps_turn_) ++turn_;
  return part;
}

void SightHistory::draw(const Scan& scan, const std::vector<std::uint8_t>& is_echo) {
  if (!keeps_turn_) return;
  Kept& kept = imageFor(scan);
  const Eigen::Isometry3d image_from_sensor = kept.sensor_from_odom * scan.odomFromSensor();
  const bool is_moved = !image_from_sensor.isApprox(Eigen::Isometry3d::Identity(), kSamePose);
  if (is_moved) in_image_.project(scan.echoes, is_echo, image_from_sensor.cast<float>());
  kept.image.add(is_moved ? in_image_ : pixels_, reading_, workspace_);
}

/// The image of the scan's sensor in the present turn; where it has none yet its frame is that of the scan.
SightHistory::Kept& SightHistory::imageFor(const Scan& scan) {
  for (auto kept = kept_.rbegin(); kept != kept_.rend() && kept->turn == turn_; ++kept) {
    if (Turns::areOne(kept->base_from_sensor, scan.base_from_sensor)) return *kept;
  }
  drawn_ = Kept{turn_began_, turn_, scan.base_from_sensor, scan.odomFromSensor().inverse(), newImage()};
  return *drawn_;
}

void SightHistory::keep() {
  if (!drawn_) return;
  forget(turn_began_ - length_);
  keepNoMoreThanAViewHolds();
  kept_.push_back(std::move(*drawn_));
  drawn_.reset();
}

void SightHistory::keepNoMoreThanAViewHolds() {
  if (kept_.size() < SightView::kMostScans) return;
  const double oldest = kept_.front().stamp;
  const auto next = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& kept) { return kept.stamp > oldest; });
  forget(next->stamp);
}

/// With storage of images that need it no longer: single lines of sight are asked of the last two turns alone.
SightImage SightHistory::newImage() {
  SightImage next;
  if (!spares_.empty()) {
    next = std::move(spares_.back());
    spares_.pop_back();
  }
  next.clear();
  for (Kept& kept : kept_) {
    const bool is_asked = kept.turn + 1 >= turn_;
    if (is_asked || kept.image.handOn(next)) break;
  }
  return next;
}

void SightHistory::forget(double until) {
  const auto is_kept = [&](const Kept& kept) { return kept.stamp >= until; };
  const auto first = std::find_if(kept_.begin(), kept_.end(), is_kept);
  std::for_each(kept_.begin(), first, [&](Kept& kept) { spares_.push_back(std::move(kept.image)); });
  kept_.erase(kept_.begin(), first);
}

void SightHistory::reset() {
  forget(std::numeric_limits<double>::infinity());
  turns_.reset();
  keeps_turn_ = false;
}

std::size_t SightHistory::countBefore() const {
  std::size_t count = kept_.size();
  while (keeps_turn_ && count > 0 && kept_[count - 1].turn == turn_) --count;
  return count;
}

SightView SightHistory::view(std::size_t newest, const Eigen::Isometry3d& odom_from_points) const {
  SightView view;
  for (std::size_t i = newest; i-- > 0;) {
    view.kept_[view.count_++] = {kept_[i].stamp, sightOf(kept_[i], odom_from_points)};
  }
  return view;
}

SightView SightHistory::seenBefore(const Eigen::Isometry3d& odom_from_points) const {
  return view(countBefore(), odom_from_points);
}

SightView SightHistory::seenFrom(const Eigen::Isometry3d& odom_from_points) const {
  return view(kept_.size(), odom_from_points);
}

ScanSight SightHistory::newestSeenFrom(const Eigen::Isometry3d& odom_from_points) const {
  ScanSight sight;
  sight.margin_ = margin_;
  const auto take = [&](const Kept& kept) { sight.images_[sight.count_++] = sightOf(kept, odom_from_points); };
  const auto is_asked = [&](const Kept& kept) { return kept.turn + 1 >= turn_ && sight.count_ < sight.images_.size(); };
  for (const bool by_newest : {true, false}) {
    for (auto kept = kept_.rbegin(); kept != kept_.rend() && is_asked(*kept); ++kept) {
      if (Turns::areOne(kept->base_from_sensor, newest_mounting_) == by_newest) take(*kept);
    }
  }
  return sight;
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
  // Both ends count, one is on its way out, and one is drawn before that is forgotten.
  const double images = length / spacing + 3.0;
  // Two images are asked for their single lines of sight as well.
  return (images + 2.0) * SightImage::answerBytes() + SightImage::workspaceBytes() + SightPixels::bytesFor(echoes);
}

std::size_t SightHistory::memoryBytes() const {
  std::size_t bytes = kept_.capacity() * sizeof(Kept) + pixels_.memoryBytes() + in_image_.memoryBytes() +
                      workspace_.memoryBytes() + turns_.memoryBytes();
  for (const Kept& kept : kept_) bytes += kept.image.memoryBytes();
  for (const SightImage& spare : spares_) bytes += spare.memoryBytes();
  return bytes;
}

}  // namespace donex
