#include "core/objects/trace_history.h"

#include <algorithm>
#include <limits>

namespace donex {

void Trace::move(const Eigen::Isometry3d& by) {
  const Eigen::Vector3d shift = by * center() - center();
  low += shift;
  high += shift;
  seen_from = by * seen_from;
  for (std::size_t i = 0; i < count; ++i) points[i] = by * points[i];
}

void TraceHistory::begin(double stamp) {
  const auto first = std::find_if(sheets_.begin(), sheets_.end(),
                                  [&](const Sheet& sheet) { return sheet.stamp > stamp - look_back_; });
  // An object that was not seen in the scan before `first` may have left its last trace the longest gap earlier.
  if (first != sheets_.begin()) forget(std::prev(first)->stamp - longest_gap_);
  Sheet next;
  if (!spares_.empty()) {
    next = std::move(spares_.back());
    spares_.pop_back();
  }
  next.stamp = stamp;
  next.entries.clear();
  next.points.clear();
  sheets_.push_back(std::move(next));
}

void TraceHistory::forget(double until) {
  const auto first =
      std::find_if(sheets_.begin(), sheets_.end(), [&](const Sheet& sheet) { return sheet.stamp >= until; });
  oldest_ += static_cast<std::uint32_t>(first - sheets_.begin());
  std::move(sheets_.begin(), first, std::back_inserter(spares_));
  sheets_.erase(sheets_.begin(), first);
}

TraceHistory::Id TraceHistory::leave(const JudgedScan& scan, const Segment& segment, Id before) {
  Sheet& sheet = sheets_.back();
  const auto first = static_cast<std::uint32_t>(sheet.points.size());
  sheet.seen_from = scan.odom_from_points * scan.sensor.cast<double>();
  visitSome(scan, segment, Trace::kMostPoints, [&](const Eigen::Vector3d& point) { sheet.points.push_back(point); });
  const auto points = static_cast<std::uint32_t>(sheet.points.size()) - first;
  sheet.entries.push_back({segment.low, segment.high, first, points, before});
  return {oldest_ + static_cast<std::uint32_t>(sheets_.size()) - 1,
          static_cast<std::uint32_t>(sheet.entries.size()) - 1};
}

bool TraceHistory::find(Id latest, double stamp, Trace& trace) const {
  for (Id id = latest; id.sheet >= oldest_;) {
    const Sheet& sheet = sheets_[id.sheet - oldest_];
    const Entry& entry = sheet.entries[id.entry];
    if (sheet.stamp <= stamp) {
      trace.stamp = sheet.stamp;
      trace.low = entry.low;
      trace.high = entry.high;
      trace.seen_from = sheet.seen_from;
      trace.count = entry.points;
      std::copy_n(sheet.points.data() + entry.first, entry.points, trace.points.data());
      return true;
    }
    id = entry.before;
  }
  return false;
}

void TraceHistory::reset() { forget(std::numeric_limits<double>::infinity()); }

std::size_t TraceHistory::memoryBytes() const {
  std::size_t bytes = (sheets_.capacity() + spares_.capacity()) * sizeof(Sheet);
  for (const auto* sheets : {&sheets_, &spares_}) {
    for (const Sheet& sheet : *sheets) {
      bytes += sheet.entries.capacity() * sizeof(Entry) + sheet.points.capacity() * sizeof(Eigen::Vector3d);
    }
  }
  return bytes;
}

}  // namespace donex
