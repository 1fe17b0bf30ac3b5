#include "core/sight/sight_history.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/grid/simd.h"
#include "core/pi.h"

namespace donex {
namespace {

constexpr double kSamePose = 1e-5;    // as isApprox has it: a part needs no new pixels
constexpr double kGapOfBeams = 1.25;  // no two of them have exactly the same step

}  // namespace

TurnPart SightHistory::arrive(const Scan& scan, const std::vector<std::uint8_t>& is_echo, const Workers& workers) {
  pixels_.project(scan.echoes, is_echo, workers);
  newest_mounting_ = scan.base_from_sensor;
  const TurnPart part = turns_.arrive(scan, pixels_, workers);
  if (part != TurnPart::kContinuing) beginTurn(scan.stamp);
  return part;
}

void SightHistory::beginTurn(double stamp) {
  for (auto kept = kept_.rbegin(); keeps_turn_ && kept != kept_.rend() && kept->turn == turn_; ++kept) {
    kept->image.measureBeams();
  }
  turn_lasted_ = stamp - turn_began_;
  turn_began_ = stamp;
  keeps_turn_ = kept_.empty() || stamp >= kept_.back().stamp + 0.9 * spacing_;
  if (keeps_turn_) ++turn_;
}

/// Of the sensor whose cloud arrived last; nullptr before its first turn is over.
const SightImage* SightHistory::newestMeasured() const {
  const auto is_its = [&](const Kept& kept) {
    return kept.image.beams().everywhere() > 0.0F && Turns::areOne(kept.base_from_sensor, newest_mounting_);
  };
  const auto newest = std::find_if(kept_.rbegin(), kept_.rend(), is_its);
  return newest == kept_.rend() ? nullptr : &newest->image;
}

double SightHistory::beamsApart() const {
  const SightImage* image = newestMeasured();
  return image == nullptr ? 0.0 : static_cast<double>(image->beams().everywhere());
}

std::optional<MeasuredSensor> SightHistory::measured() const {
  const SightImage* image = newestMeasured();
  if (image == nullptr || !(turn_lasted_ > 0.0)) return std::nullopt;
  const auto degrees = [](double tangent) { return std::atan(tangent) / kRadiansPerDegree; };
  const auto elevation = [&](int row) {
    return degrees((row + 0.5) * SightPixels::kRowHeight - SightPixels::kSteepest);
  };
  const BeamSpacing& beams = image->beams();
  const double around = 360.0 * static_cast<double>(image->coveredColumns()) / SightPixels::kColumns;
  return MeasuredSensor{degrees(beamsApart()), elevation(beams.span().lowest), elevation(beams.span().highest), around,
                        1.0 / turn_lasted_};
}

void SightHistory::draw(const Scan& scan, const std::vector<std::uint8_t>& is_echo) {
  if (!keeps_turn_) return;
  Kept& kept = imageFor(scan);
  const Eigen::Isometry3d image_from_sensor = kept.sensor_from_odom * scan.odomFromSensor();
  const bool is_moved = !image_from_sensor.isApprox(Eigen::Isometry3d::Identity(), kSamePose);
  if (is_moved) in_image_.project(scan.echoes, is_echo, image_from_sensor.cast<float>());
  kept.image.add(is_moved ? in_image_ : pixels_, readingOfNewest(), workspace_);
}

/// Beams that lie farther apart than any gap that was configured are neighbours all the same.
SightImage::Reading SightHistory::readingOfNewest() const {
  SightImage::Reading reading = reading_;
  reading.largest_gap = std::max(reading.largest_gap, kGapOfBeams * beamsApart());
  return reading;
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
  view.margin_ = margin_;
  view.is_careful_ = reading_.careful;
  for (std::size_t i = newest; i-- > 0;) {
    view.add(kept_[i].stamp, sightOf(kept_[i], odom_from_points));
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

void SightView::add(double stamp, const ImageSight& sight) {
  kept_[count_] = {stamp, sight.image, 0.0};
  if (count_ > 0) kept_[count_ - 1].turn_lasted = kept_[count_ - 1].stamp - stamp;
  for (std::size_t row = 0; row < 3; ++row) {
    const auto axis = static_cast<Eigen::Index>(row);
    for (std::size_t column = 0; column < 3; ++column) {
      placements_.rotation[row][column][count_] =
          sight.sensor_from_points.linear()(axis, static_cast<Eigen::Index>(column));
    }
    placements_.translation[row][count_] = sight.sensor_from_points.translation()[axis];
  }
  ++count_;
}

/// In the first `count` images. The order of the sums is Eigen's.
inline void SightView::place(const Eigen::Vector3f& point, std::size_t count, Pixels& pixels) const {
  const auto& [to_x, to_y, to_z] = placements_.rotation;
  const auto& [x, y, z] = placements_.translation;
  const float a = point.x(), b = point.y(), c = point.z();
  for (std::size_t i = 0; i < count; ++i) {
    const SightPixels::Pixel pixel = SightPixels::of(to_x[0][i] * a + to_x[1][i] * b + to_x[2][i] * c + x[i],
                                                     to_y[0][i] * a + to_y[1][i] * b + to_y[2][i] * c + y[i],
                                                     to_z[0][i] * a + to_z[1][i] * b + to_z[2][i] * c + z[i]);
    pixels.valid[i] = static_cast<std::int32_t>(pixel.valid);
    pixels.column[i] = pixel.column;
    pixels.row[i] = pixel.row;
    pixels.range[i] = pixel.range;
  }
}

DONEX_WIDE_LOOPS SightView::Evidence SightView::ask(const Eigen::Vector3f& point, double since, int enough,
                                                    float margin) const {
  std::size_t count = 0;
  while (count < count_ && kept_[count].stamp > since) ++count;
  Pixels pixels;
  place(point, count, pixels);
  Evidence evidence;
  int is_overlooked = 1;  // in the turn
  for (std::size_t i = 0; i < count && evidence.free < enough; ++i) {
    const SightPixels::Pixel pixel{pixels.valid[i] != 0, pixels.column[i], pixels.row[i], pixels.range[i]};
    const SightImage::Sight sight = kept_[i].image->atPixel(pixel, margin);
    // Counted without a branch: neighbouring scans differ in what they say.
    const int is_surface = sight == SightImage::Sight::kSurface ? 1 : 0;
    is_overlooked &= sight == SightImage::Sight::kUnknown && !kept_[i].image->sees(pixel) ? 1 : 0;
    evidence.overlooked += evidence.free == 0 ? is_overlooked * kept_[i].turn_lasted : 0.0;
    is_overlooked |= kept_[i].turn_lasted > 0.0 ? 1 : 0;
    evidence.stale_surface += evidence.free > 0 ? is_surface : 0;
    evidence.lasting_surface += kept_[0].stamp - kept_[i].stamp >= Evidence::kApproach ? is_surface : 0;
    evidence.surface += is_surface;
    evidence.hidden += sight == SightImage::Sight::kHidden ? 1 : 0;
    if (sight != SightImage::Sight::kFree) continue;
    const float apart = is_careful_ ? kept_[i].image->beamsApart(pixel) : 0.0F;
    ++evidence.free;
    evidence.certain_free += apart <= certainty_.gap ? 1.0F : std::max(certainty_.least, certainty_.gap / apart);
    evidence.fine_free += apart <= certainty_.fine_gap ? 1.0F : certainty_.fine_gap / apart;
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
