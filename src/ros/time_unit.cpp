#include "ros/time_unit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <vector>

#include <sensor_msgs/PointField.h>

#include "ros/conversions.h"

namespace donex {
namespace {

bool countsFromStamp(TimeEncoding encoding) {
  return encoding == TimeEncoding::kRelativeSeconds || encoding == TimeEncoding::kRelativeMicroseconds ||
         encoding == TimeEncoding::kRelativeNanoseconds;
}

bool isSame(const TimeField& a, const TimeField& b) {
  return a.position.offset == b.position.offset && a.position.datatype == b.position.datatype &&
         a.encoding == b.encoding;
}

}  // namespace

bool TimeUnit::observe(const sensor_msgs::PointCloud2& cloud, const CloudLayout& layout) {
  const auto interval = intervalUntil(cloud.header.stamp.toSec());
  const bool is_judged = layout.time && !layout.time->is_told && countsFromStamp(layout.time->encoding);
  if (!is_judged || (field_ && !isSame(*field_, *layout.time))) {
    unit_.reset();
    finding_.clear();
  }
  field_ = layout.time;
  if (!is_judged || !interval) return false;
  const auto span = sampledSpan(cloud, layout);
  if (!span) return false;
  const auto unit = unusualUnit(*layout.time, *span, *interval);
  const bool is_news = unit.has_value() != unit_.has_value() || (unit && unit->name != unit_->name);
  unit_ = unit;
  if (!is_news) return false;
  finding_ = unit ? describe(*unit, *span, *interval) : "";
  return true;
}

void TimeUnit::apply(CloudLayout& layout) const {
  if (!layout.time || !unit_ || !field_ || !isSame(*field_, *layout.time)) return;
  layout.time->unit = unit_->seconds;
}

/// The median of the last intervals. Clouds of one stamp are parts of one scan or of synchronised sensors.
std::optional<double> TimeUnit::intervalUntil(double stamp) {
  if (last_stamp_ && stamp > *last_stamp_) intervals_.push_back(stamp - *last_stamp_);
  last_stamp_ = stamp;
  if (intervals_.size() > options_.intervals) intervals_.pop_front();
  if (intervals_.empty()) return std::nullopt;
  std::vector<double> sorted(intervals_.begin(), intervals_.end());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

/// Without the outermost hundredths: a wild time is not the scan's.
std::optional<TimeUnit::Span> TimeUnit::sampledSpan(const sensor_msgs::PointCloud2& cloud,
                                                    const CloudLayout& layout) const {
  std::vector<double> times = sampleWrittenTimes(cloud, layout, options_.sampled_echoes);
  times.erase(std::remove_if(times.begin(), times.end(), [](double time) { return !std::isfinite(time); }),
              times.end());
  if (times.size() < 2) return std::nullopt;
  std::sort(times.begin(), times.end());
  const std::size_t outermost = times.size() / 100;
  return Span{times[outermost], times[times.size() - 1 - outermost]};
}

std::string TimeUnit::describe(const Unit& unit, const Span& span, double interval) {
  std::ostringstream text;
  text << "echoes' times are read as " << unit.name << ": they span " << span.last - span.first
       << " as written, and the clouds are " << interval << " s apart; time_field and time_encoding overrule this";
  return text.str();
}

/// Nothing where the usual unit is possible, or where no other fits.
std::optional<TimeUnit::Unit> TimeUnit::unusualUnit(const TimeField& field, const Span& span, double interval) const {
  const double length = span.last - span.first;
  const bool are_shares = field.position.datatype == sensor_msgs::PointField::FLOAT32 && span.first >= 0.0 &&
                          span.last <= 1.0 && length >= options_.least_span_of_shares &&
                          interval <= options_.longest_interval_of_shares;
  if (are_shares) return Unit{interval, "shares of the scan"};
  const double usual = field.encoding == TimeEncoding::kRelativeSeconds        ? 1.0
                       : field.encoding == TimeEncoding::kRelativeMicroseconds ? 1e-6
                                                                               : 1e-9;
  const double share = usual * length / interval;
  if (share >= options_.least_possible_share && share <= options_.most_possible_share) return std::nullopt;
  constexpr std::array<Unit, 4> kUnits{
      {{1.0, "seconds"}, {1e-3, "milliseconds"}, {1e-6, "microseconds"}, {1e-9, "nanoseconds"}}};
  for (const Unit& unit : kUnits) {
    const double filled = unit.seconds * length / interval;
    if (filled >= options_.least_filled_share && filled <= options_.most_filled_share) return unit;
  }
  return std::nullopt;
}

}  // namespace donex
