#include "core/sight/turns.h"

#include <algorithm>
#include <bitset>
#include <utility>

namespace donex {
namespace {

constexpr std::size_t kColumns = SightPixels::kColumns;
constexpr std::size_t kWidestGap = kColumns / 12;  // columns; a cloud with echoes on both sides looks at it, too
constexpr std::size_t kBorder = 2;                 // columns that a part may share with the one beside
constexpr double kMostOfReach = 0.8;               // bands; a cloud of fewer is a part that was cut by elevation
constexpr std::size_t kFewest = 50;                // echoes; fewer do not tell that scans come in parts
constexpr std::size_t kRepeated = 4;               // one in so many columns seen again: the sensor looks there again

bool hasEnough(const SightPixels& seen) {
  std::size_t echoes = 0;
  for (std::size_t i = 0; i < seen.size() && echoes < kFewest; ++i) echoes += seen.row(i) >= 0 ? 1U : 0U;
  return echoes == kFewest;
}

int count(Turns::Bands bands) { return static_cast<int>(std::bitset<Turns::kBands>(bands).count()); }

/// The bands from the lowest to the highest echo.
Turns::Bands reachedBy(const SightPixels::Span& span) {
  if (span.highest < 0) return 0;
  const int first = Turns::bandOf(span.lowest), last = Turns::bandOf(span.highest);
  return (Turns::kAllBands >> (Turns::kBands - 1 - last)) & (Turns::kAllBands << first);
}

}  // namespace

TurnPart Turns::arrive(const Scan& scan, const SightPixels& seen, const Workers& workers) {
  newest_ = columnsOf(seen, workers);
  Sensor* sensor = sensorAt(scan.base_from_sensor);
  const bool is_long = sensors_.empty() || scan.stamp - begin_ > kLongest;
  const bool is_one_more = sensor == nullptr && sensors_.size() < kMostSensors;
  const SightPixels::Span span = seen.span();
  newest_bands_ = bandsOf(scan.base_from_sensor, span);
  const bool looks_again = sensor != nullptr && looksAgain(*sensor, reachedBy(span));
  const bool has_enough = hasEnough(seen);
  const bool may_be_part = cloudsPerTurn() > 1 || (has_enough && newest_has_enough_);
  const bool goes_on = !is_long && may_be_part && (sensor != nullptr ? !looks_again : is_one_more);
  if (!goes_on) {
    begin_ = scan.stamp;
    sensors_.clear();
    sensor = nullptr;
    for (Reach& reach : reaches_) reach.before = std::exchange(reach.now, 0);
  }
  if (sensor == nullptr) {
    sensors_.push_back({scan.base_from_sensor, {}});
    sensor = &sensors_.back();
  }
  for (std::size_t c = 0; c < kColumns; ++c) sensor->looked[c] |= newest_[c] != 0 ? newest_bands_ : 0;
  reachOf(scan.base_from_sensor).now |= reachedBy(span);
  newest_sensor_ = static_cast<std::size_t>(sensor - sensors_.data());
  newest_has_enough_ = has_enough;
  if (goes_on) {
    ++clouds_;
    return TurnPart::kContinuing;
  }
  clouds_before_ = std::exchange(clouds_, 1);
  return clouds_before_ > 1 ? TurnPart::kFirst : TurnPart::kWhole;
}

/// Whether these bands, or those looked at before, are for the most part the same, in more columns than parts share.
bool Turns::looksAgain(const Sensor& sensor, Bands bands) const {
  std::size_t again = 0, all = 0;
  for (std::size_t c = 0; c < kColumns; ++c) {
    const Bands looked = sensor.looked[c];
    all += newest_[c];
    again += newest_[c] != 0 && 2 * count(bands & looked) > std::min(count(bands), count(looked)) ? 1U : 0U;
  }
  return (again > kBorder && kRepeated * again > all) || (all > 0 && again == all);
}

/// A cloud that reaches over most of what its sensor saw in the turn before looks at all of it: what is missing is sky.
Turns::Bands Turns::bandsOf(const Eigen::Isometry3d& base_from_sensor, const SightPixels::Span& span) {
  const Reach& reach = reachOf(base_from_sensor);
  const Bands bands = reachedBy(span), known = bands | reach.before | reach.now;
  return static_cast<double>(count(bands)) < kMostOfReach * count(known) ? bands : kAllBands;
}

Turns::Reach& Turns::reachOf(const Eigen::Isometry3d& base_from_sensor) {
  const auto known = std::find_if(reaches_.begin(), reaches_.end(),
                                  [&](const Reach& reach) { return areOne(reach.base_from_sensor, base_from_sensor); });
  if (known != reaches_.end()) return *known;
  if (reaches_.size() >= kMostSensors) reaches_.erase(reaches_.begin());
  reaches_.push_back({base_from_sensor, 0, 0});
  return reaches_.back();
}

bool Turns::areOne(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  const bool is_there = (a.translation() - b.translation()).norm() < kSamePlace;
  return is_there && (a.linear() - b.linear()).norm() < kSameAxes;
}

Turns::Sensor* Turns::sensorAt(const Eigen::Isometry3d& base_from_sensor) {
  const auto sensor = std::find_if(sensors_.begin(), sensors_.end(), [&](const Sensor& known) {
    return areOne(known.base_from_sensor, base_from_sensor);
  });
  return sensor == sensors_.end() ? nullptr : &*sensor;
}

Turns::Columns Turns::columnsOf(const SightPixels& seen, const Workers& workers) {
  in_stretch_.assign((seen.size() + kStretch - 1) / kStretch, Columns{});
  forEachStretch(workers, seen.size(), [&](std::size_t first, std::size_t last) {
    Columns& columns = in_stretch_[first / kStretch];
    for (std::size_t i = first; i < last; ++i) {
      if (seen.row(i) >= 0) columns[static_cast<std::size_t>(seen.column(i))] = 1;
    }
  });
  Columns columns{};
  for (const Columns& some : in_stretch_) {
    for (std::size_t c = 0; c < kColumns; ++c) columns[c] = std::max(columns[c], some[c]);
  }
  const auto first = static_cast<std::size_t>(std::find(columns.begin(), columns.end(), 1) - columns.begin());
  if (first == kColumns) return columns;
  std::size_t last = first;
  for (std::size_t step = 1; step <= kColumns; ++step) {
    const std::size_t c = (first + step) % kColumns;
    if (step < kColumns && columns[c] == 0) continue;
    const std::size_t gap = (c + kColumns - last - 1) % kColumns;
    for (std::size_t k = 1; gap <= kWidestGap && k <= gap; ++k) columns[(last + k) % kColumns] = 1;
    last = c;
  }
  return columns;
}

}  // namespace donex
