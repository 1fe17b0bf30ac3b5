// Which unit the times of a stream's echoes are in, and which of them are none of the scan's: drivers give one name and
// one datatype different units.
#pragma once

#include <array>
#include <deque>
#include <optional>
#include <string>
#include <string_view>

#include <sensor_msgs/PointCloud2.h>

#include "ros/cloud_layout.h"

namespace donex {

/// Finds the unit of times that count from the stamp by comparing what they span within a cloud with the time between
/// clouds; that of absolute ones by the stamp. Judges again with every cloud; the usual unit stands unless another one
/// fits and it does not. No unit is judged where the configuration tells the encoding. A field whose name only looks
/// like a time is one where some unit fits.
class TimeUnit {
 public:
  struct Options {
    /// Intervals between clouds whose median counts: lost clouds and late stamps are outvoted.
    std::size_t intervals = 15;
    /// A unit is possible where the times span at least this share of the interval: a sensor of any kind that fires
    /// within a thirtieth of its period keeps its usual unit. Units are a thousand apart: at most one is possible.
    double least_possible_share = 1.0 / 30.0;
    /// ... and at most this one: scans may overlap, and every other cloud may be lost.
    double most_possible_share = 3.0;
    /// Another unit than the usual one is only believed where the times fill the interval as a whole turn does: from
    /// two thirds of a turn in a cloud, with some lost at the borders,
    double least_filled_share = 0.3;
    double most_filled_share = 1.5;  ///< up to a turn and what intervals vary by.
    /// Numbers from 0 to 1 are shares of the scan, not seconds, where clouds follow closer than this [s]; a scan of a
    /// full second is refused as times anyway.
    double longest_interval_of_shares = 0.5;
    double least_span_of_shares = 0.9;  ///< of the whole scan; the ends may be missing.
    /// Echoes whose times are looked at, evenly spread over the cloud; the outermost hundredths do not count.
    std::size_t sampled_echoes = 1000;
    /// A time farther outside of what nearly all span, and of an interval, is wild; in shares of that span.
    double wild_margin = 0.25;
    double longest_scan = 1.0;  ///< absolute times lie nearer to the stamp [s]
  };

  TimeUnit() : TimeUnit(Options()) {}
  explicit TimeUnit(const Options& options) : options_(options) {}

  /// Takes the clouds in the order of their arrival; true when the unit is another one than before. Sets in `layout`
  /// between which times the cloud was measured.
  bool observe(const sensor_msgs::PointCloud2& cloud, CloudLayout& layout);

  /// Sets the found unit in a layout of the same stream; removes a field that only looks like a time and is none.
  void apply(CloudLayout& layout) const;

  /// From cloud to cloud: the median of the last [s]; nothing before the second.
  std::optional<double> interval() const;
  /// What was found, with the figures; empty while the unit is the usual one.
  const std::string& finding() const { return finding_; }
  /// Fit to follow the field's name: "microseconds"; empty while the unit is the usual one.
  std::string_view unit() const { return unit_ ? unit_->name : std::string_view(); }

 private:
  struct Span {
    double first, last;  // as written
  };
  struct Unit {
    double seconds;
    std::string_view name;
    bool is_absolute = false;
  };
  static const std::array<Unit, 4>& units();

  void follow(double stamp);
  std::optional<Span> sampledSpan(const sensor_msgs::PointCloud2& cloud, const CloudLayout& layout) const;
  void bound(const Span& span, double interval, TimeField& field) const;
  std::optional<Unit> absoluteUnit(const Span& span, double stamp) const;
  std::optional<Unit> unusualUnit(const TimeField& field, const Span& span, double interval, double stamp) const;
  std::optional<Unit> filledUnit(double length, double interval) const;
  std::string describe(const Unit& unit, const Span& span, double interval) const;

  Options options_;
  std::optional<double> last_stamp_;  // [s]
  std::deque<double> intervals_;      // [s], the newest last
  std::optional<TimeField> field_;    // of the last cloud
  std::optional<Unit> unit_;          // where it is not the usual one
  std::string finding_;
};

}  // namespace donex
