#include "core/sight/turns.h"

#include <algorithm>
#include <utility>

namespace donex {
namespace {

constexpr std::size_t kColumns = SightPixels::kColumns;
constexpr std::size_t kWidestGap = kColumns / 12;  // columns; a cloud with echoes on both sides looks at it, too
constexpr std::size_t kBorder = 2;                 // columns that a part may share with the one beside
constexpr std::size_t kFewest = 50;                // echoes; fewer do not tell that scans come in parts
constexpr std::size_t kRepeated = 4;               // one in so many columns seen again: the sensor looks there again

bool hasEnough(const SightPixels& seen) {
  std::size_t echoes = 0;
  for (std::size_t i = 0; i < seen.size() && echoes < kFewest; ++i) echoes += seen.row(i) >= 0 ? 1U : 0U;
  return echoes == kFewest;
}

}  // namespace

TurnPart Turns::arrive(const Scan& scan, const SightPixels& seen, const Workers& workers) {
  newest_ = columnsOf(seen, workers);
  const Columns& columns = newest_;
  Sensor* sensor = sensorAt(scan.base_from_sensor);
  const bool is_long = sensors_.empty() || scan.stamp - begin_ > kLongest;
  const bool is_one_more = sensor == nullptr && sensors_.size() < kMostSensors;
  std::size_t again = 0, all = 0;
  for (std::size_t c = 0; sensor != nullptr && c < kColumns; ++c) {
    all += columns[c];
    again += std::min(columns[c], sensor->looked[c]);
  }
  const bool looks_again = (again > kBorder && kRepeated * again > all) || (all > 0 && again == all);
  const bool has_enough = hasEnough(seen);
  const bool may_be_part = cloudsPerTurn() > 1 || (has_enough && newest_has_enough_);
  const bool goes_on = !is_long && may_be_part && (sensor != nullptr ? !looks_again : is_one_more);
  if (!goes_on) {
    begin_ = scan.stamp;
    sensors_.clear();
    sensor = nullptr;
  }
  if (sensor == nullptr) {
    sensors_.push_back({scan.base_from_sensor, columns});
    sensor = &sensors_.back();
  } else {
    for (std::size_t c = 0; c < kColumns; ++c) sensor->looked[c] = std::max(sensor->looked[c], columns[c]);
  }
  newest_sensor_ = static_cast<std::size_t>(sensor - sensors_.data());
  newest_has_enough_ = has_enough;
  if (goes_on) {
    ++clouds_;
    return TurnPart::kContinuing;
  }
  clouds_before_ = std::exchange(clouds_, 1);
  return clouds_before_ > 1 ? TurnPart::kFirst : TurnPart::kWhole;
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
