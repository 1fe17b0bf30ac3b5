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

bool isSame(const TimeField& a, const TimeField& b) {
  return a.position.offset == b.position.offset && a.position.datatype == b.position.datatype &&
         a.encoding == b.encoding;
}

double usualUnit(TimeEncoding encoding) {
  switch (encoding) {
    case TimeEncoding::kRelativeMicroseconds: return 1e-6;
    case TimeEncoding::kRelativeNanoseconds:
    case TimeEncoding::kAbsoluteNanoseconds: return 1e-9;
    default: return 1.0;
  }
}

}  // namespace

bool TimeUnit::observe(const sensor_msgs::PointCloud2& cloud, CloudLayout& layout) {
  const double stamp = cloud.header.stamp.toSec();
  follow(stamp);
  const auto interval = this->interval();
  const auto span = layout.time ? sampledSpan(cloud, layout) : std::nullopt;
  const bool is_judged = layout.time && !layout.time->is_told;
  if (!is_judged || (field_ && !isSame(*field_, *layout.time))) {
    unit_.reset();
    finding_.clear();
  }
  field_ = layout.time;
  if (span) bound(*span, interval.value_or(0.0), *layout.time);
  if (!is_judged || !interval || !span) return false;
  const auto unit = unusualUnit(*layout.time, *span, *interval, stamp);
  const bool is_news = unit.has_value() != unit_.has_value() || (unit && unit->name != unit_->name);
  unit_ = unit;
  if (!is_news) return false;
  finding_ = unit ? describe(*unit, *span, *interval) : "";
  return true;
}

/// A scan may be sparse at its ends: what lies within one interval is the scan's.
void TimeUnit::bound(const Span& span, double interval, TimeField& field) const {
  const double length = span.last - span.first;
  const bool is_nanoseconds = field.encoding == TimeEncoding::kAuto && span.last > kSecondsOfNoClock;
  const double unit = unit_ ? unit_->seconds : is_nanoseconds ? 1e-9 : usualUnit(field.encoding);
  const double margin = std::max(options_.wild_margin * length, interval / unit - length);
  field.first = span.first;
  field.last = span.last;
  field.least = span.first - margin;
  field.most = span.last + margin;
}

void TimeUnit::apply(CloudLayout& layout) const {
  if (!layout.time) return;
  const bool is_known = unit_ && field_ && isSame(*field_, *layout.time);
  if (is_known) {
    layout.time->unit = unit_->seconds;
    const bool is_relative = !unit_->is_absolute && layout.time->encoding == TimeEncoding::kAuto;
    if (is_relative) layout.time->encoding = TimeEncoding::kRelativeSeconds;
    if (unit_->is_absolute) layout.time->encoding = TimeEncoding::kAbsoluteSeconds;
  } else if (layout.time->is_guess) {
    layout.time.reset();
  }
}

/// Clouds of one stamp are parts of one scan or of synchronised sensors.
void TimeUnit::follow(double stamp) {
  if (last_stamp_ && stamp > *last_stamp_) intervals_.push_back(stamp - *last_stamp_);
  last_stamp_ = stamp;
  if (intervals_.size() > options_.intervals) intervals_.pop_front();
}

std::optional<double> TimeUnit::interval() const {
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

std::string TimeUnit::describe(const Unit& unit, const Span& span, double interval) const {
  std::ostringstream text;
  text << "echoes' times in '" << field_->name << "' are read as " << unit.name
       << (unit.is_absolute ? " since 1970" : "") << ": they span " << span.last - span.first
       << " as written, and the clouds are " << interval << " s apart; time_field and time_encoding overrule this";
  return text.str();
}

const std::array<TimeUnit::Unit, 4>& TimeUnit::units() {
  static const std::array<Unit, 4> units{
      {{1.0, "seconds"}, {1e-3, "milliseconds"}, {1e-6, "microseconds"}, {1e-9, "nanoseconds"}}};
  return units;
}

/// In which the times lie around the stamp.
std::optional<TimeUnit::Unit> TimeUnit::absoluteUnit(const Span& span, double stamp) const {
  for (Unit unit : units()) {
    unit.is_absolute = true;
    const double first = unit.seconds * span.first - stamp, last = unit.seconds * span.last - stamp;
    if (std::abs(first) < options_.longest_scan && std::abs(last) < options_.longest_scan) return unit;
  }
  return std::nullopt;
}

/// In which the times fill the interval.
std::optional<TimeUnit::Unit> TimeUnit::filledUnit(double length, double interval) const {
  for (const Unit& unit : units()) {
    const double filled = unit.seconds * length / interval;
    if (filled >= options_.least_filled_share && filled <= options_.most_filled_share) return unit;
  }
  return std::nullopt;
}

/// Nothing where the usual unit is possible, or where no other fits.
std::optional<TimeUnit::Unit> TimeUnit::unusualUnit(const TimeField& field, const Span& span, double interval,
                                                    double stamp) const {
  const double length = span.last - span.first;
  if (field.encoding == TimeEncoding::kAuto) {
    const auto absolute = absoluteUnit(span, stamp);
    const bool is_usual = absolute && (absolute->seconds == 1.0 || absolute->seconds == 1e-9) && !field.is_guess;
    if (is_usual) return std::nullopt;
    if (absolute) return absolute;
    const bool may_be_relative = std::max(std::abs(span.first), std::abs(span.last)) <= 2.0 * length;
    return may_be_relative ? filledUnit(length, interval) : std::nullopt;
  }
  const bool are_shares = field.position.datatype == sensor_msgs::PointField::FLOAT32 && span.first >= 0.0 &&
                          span.last <= 1.0 && length >= options_.least_span_of_shares &&
                          interval <= options_.longest_interval_of_shares;
  if (are_shares) return Unit{interval, "shares of the scan"};
  const double share = usualUnit(field.encoding) * length / interval;
  const bool is_possible = share >= options_.least_possible_share && share <= options_.most_possible_share;
  return is_possible && !field.is_guess ? std::nullopt : filledUnit(length, interval);
}

}  // namespace donex
