#include "ros/echo_clock.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace donex {
namespace {

/// What drivers and converters are known to write. The first holds until the scans tell otherwise.
std::vector<TimeReading> knownReadings() {
  return {{1.0, 0.0, "as they are written"},
          {0.0, 0.0, "as what is undone already: the clouds were de-skewed before"},
          {1.0, -1.0, "a scan earlier: they count from its begin, and the stamp is its end"},
          {1.0, 1.0, "a scan later: they count from its end, and the stamp is its begin"},
          {-1.0, 0.0, "backwards from the stamp"}};
}

/// Where a spinning sensor's clouds carry no times: what its drivers stamp.
std::vector<TimeReading> readingsByFirings() {
  return {{0.0, 0.0, "none"},
          {1.0, -1.0, "the stamp is the scan's end"},
          {1.0, 0.0, "the stamp is the scan's begin"},
          {1.0, -0.5, "the stamp is the scan's middle"}};
}

/// Where clouds begin elsewhere than the sensor did, it is often across from there.
std::vector<TimeReading> readingsByRows() {
  std::vector<TimeReading> readings = readingsByFirings();
  readings.push_back({1.0, -1.0, "half a turn later, the stamp is the scan's end", 0.5});
  readings.push_back({1.0, 0.0, "half a turn later, the stamp is the scan's begin", 0.5});
  readings.push_back({1.0, -0.5, "half a turn later, the stamp is the scan's middle", 0.5});
  return readings;
}

/// On straight roads these readings hardly differ.
DeskewChoice::Options optionsByAzimuth() {
  DeskewChoice::Options options;
  options.most_lost = 0.2;
  options.lost = 0.01;
  return options;
}

/// So many clouds tell how far apart clouds are.
constexpr int kPatience = 5;

/// So many pairs of scans tell whether times by azimuth fit better.
constexpr std::size_t kPairs = DeskewChoice::Options().least_pairs;

void reread(const TimeReading& reading, EchoTimes& times) {
  if (reading.factor == 1.0 && reading.spans == 0.0) return;
  if (reading.undoesNothing()) return times.clear();
  const double span = times.last - times.first;
  for (float& time : times.after_stamp) time = static_cast<float>(reading(static_cast<double>(time), span));
  const double first = reading.scaled(times.first, span), last = reading.scaled(times.last, span);
  times.first = std::min(first, last);
  times.last = std::max(first, last);
}

}  // namespace

EchoClock::EchoClock(const Config& config)
    : motion_(config.motion),
      wanted_(config.cloud.time_field),
      choice_(knownReadings()),
      choice_by_firings_(readingsByFirings(), optionsByAzimuth()),
      choice_by_rows_(readingsByRows(), optionsByAzimuth()) {}

/// Whether echoes are to be de-skewed at all.
bool EchoClock::isAsked() const { return motion_.deskew && motion_.source != OdometrySource::kNone; }

bool EchoClock::observe(const sensor_msgs::PointCloud2& cloud, CloudLayout& layout) {
  const bool is_news = isAsked() && unit_.observe(cloud, layout);
  if (is_news) state_ = State::kNotYet;
  return is_news;
}

void EchoClock::read(const sensor_msgs::PointCloud2& cloud, const CloudLayout& layout,
                     std::vector<Eigen::Vector3f>& echoes, EchoTimes& times) {
  CloudLayout used = layout;
  if (isAsked()) {
    unit_.apply(used);
  } else {
    used.time.reset();
  }
  parseEchoes(cloud, used, echoes, times);
  not_understood_ = layout.time && !used.time ? std::min(not_understood_ + 1, kPatience) : 0;
  is_by_azimuth_ = lacksTimes(layout, used, times);
  const double stamp = cloud.header.stamp.toSec();
  if (is_by_azimuth_) tellByAzimuth(stamp, layout, echoes, times);
  const bool is_told = layout.time && layout.time->is_told;  // who tells the encoding means it
  is_compared_ = is_by_azimuth_ || (!times.empty() && !is_told);
  if (is_compared_ && !times.empty()) {
    first_ = times.first;
    last_ = times.last;
    choice().take(stamp, echoes, times.after_stamp);
  }
  const State state = stateOf(layout, used, times);
  if (state != state_ || state == State::kNotYet || is_by_azimuth_) {
    state_ = state;
    deskewed_by_ = describe(state, cloud, layout, times);
  }
  if (is_compared_ && !times.empty()) reread(choice().reading(), times);
}

bool EchoClock::lacksTimes(const CloudLayout& layout, const CloudLayout& used, const EchoTimes& times) const {
  const bool is_told = !wanted_.empty() || (layout.time && layout.time->is_told);
  if (!isAsked() || is_told || !times.problem.empty() || layout.echoes() == 0) return false;
  if (!used.time) return !layout.time || not_understood_ >= kPatience;
  return times.empty() || times.first == times.last;
}

/// What is not asked for is not looked at.
void EchoClock::tellByAzimuth(double stamp, const CloudLayout& layout, const std::vector<Eigen::Vector3f>& echoes,
                              EchoTimes& times) {
  times.clear();
  const bool is_idle = byAzimuth().reading().undoesNothing() && !byAzimuth().wants(stamp);
  const auto interval = unit_.interval();
  if (is_idle || !interval) return;
  has_order_ = azimuth_times_.read(stamp, echoes, layout.width, *interval, times.after_stamp);
  if (!has_order_) return;
  const auto ends = std::minmax_element(times.after_stamp.begin(), times.after_stamp.end());
  times.first = static_cast<double>(*ends.first);
  times.last = static_cast<double>(*ends.second);
}

bool EchoClock::follow(double stamp, const Eigen::Isometry3d& odom_from_sensor) {
  if (!is_compared_ || !choice().follow(stamp, odom_from_sensor)) return false;
  std::ostringstream text;
  if (is_by_azimuth_) {
    text << "the clouds carry no times of echoes, and are de-skewed by " << azimuth();
  } else {
    text << "echoes' times, from " << first_ << " to " << last_ << " s after the stamp, are read "
         << choice_.reading().meaning;
  }
  text << "; so the scans fit one another better by " << std::lround(100.0 * choice().gain()) << " %; "
       << (is_by_azimuth_ ? "deskew" : "time_encoding") << " overrules this";
  reading_finding_ = text.str();
  state_ = State::kNotYet;
  return true;
}

std::string EchoClock::untoldLack() {
  const bool is_lack = state_ == State::kNoField || state_ == State::kNotUnderstood || state_ == State::kAlike;
  if (!is_lack || state_ == told_lack_) return "";
  told_lack_ = state_;
  return deskewed_by_;
}

EchoClock::State EchoClock::stateOf(const CloudLayout& layout, const CloudLayout& used, const EchoTimes& times) const {
  if (motion_.source == OdometrySource::kNone) return State::kAtRest;
  if (!motion_.deskew) return State::kOff;
  const bool is_by_azimuth = is_by_azimuth_ && !times.empty() && !byAzimuth().reading().undoesNothing();
  if (is_by_azimuth) return State::kAzimuth;
  if (!layout.time) return wanted_.empty() ? State::kNoField : State::kTold;
  if (!used.time) return not_understood_ < kPatience ? State::kNotYet : State::kNotUnderstood;
  if (!times.problem.empty()) return State::kStrange;
  if (layout.echoes() == 0) return state_;  // a part in which the sensor saw nothing tells nothing
  if (is_by_azimuth_ || times.empty() || times.first == times.last) return State::kAlike;
  return choice_.reading().undoesNothing() && !layout.time->is_told ? State::kUndone : State::kTimes;
}

std::string EchoClock::describe(State state, const sensor_msgs::PointCloud2& cloud, const CloudLayout& layout,
                                const EchoTimes& times) const {
  std::ostringstream text;
  switch (state) {
    case State::kNotYet: return "not known yet";
    case State::kOff: return "nothing: deskew is false";
    case State::kAtRest: return "nothing: the sensor is at rest";
    case State::kTold:
      text << "nothing: the cloud has no field '" << wanted_ << "' with times (FLOAT32, FLOAT64, UINT32 or INT32); "
           << "fields: " << fieldNames(cloud);
      break;
    case State::kNoField:
      text << "nothing: the clouds carry no times of echoes; fields: " << fieldNames(cloud) << "; " << azimuthLack();
      break;
    case State::kNotUnderstood:
      text << "nothing: '" << layout.time->name
           << "' looks like echoes' times, but spans nothing like a scan in any unit; time_field and time_encoding "
              "tell; "
           << azimuthLack();
      break;
    case State::kAlike:
      text << "nothing: all times in '" << layout.time->name << "' are alike; " << azimuthLack();
      break;
    case State::kAzimuth: text << azimuth(); break;
    case State::kStrange: text << "nothing: " << times.problem; break;
    case State::kUndone:
      text << "nothing: the clouds were de-skewed before, as their scans say; their times are still there";
      break;
    case State::kTimes:
      text << "times in '" << layout.time->name << "'" << (unit_.unit().empty() ? "" : ", ") << unit_.unit()
           << ", from " << times.first << " to " << times.last << " s after the stamp, read "
           << choice_.reading().meaning;
      break;
  }
  return text.str();
}

std::string EchoClock::azimuth() const {
  const Spin& spin = azimuth_times_.spin();
  std::ostringstream text;
  text << "azimuth, " << (spin.isClockwise() ? "" : "counter-") << "clockwise from "
       << std::lround(360.0F * spin.start()) << " degrees, " << byAzimuth().reading().meaning;
  return text.str();
}

std::string EchoClock::azimuthLack() const {
  if (!unit_.interval()) return "whether azimuth tells is not known yet";
  if (!has_order_) return "the order of the echoes does not tell how the sensor turned";
  return byAzimuth().pairs() < kPairs ? "whether times by azimuth fit is looked at while the vehicle moves"
                                      : "with times by azimuth the scans do not fit one another better";
}

EchoClock& EchoClocks::of(const std::string& frame) {
  if (clocks_.size() >= kMostFrames && clocks_.count(frame) == 0) clocks_.clear();
  return clocks_.try_emplace(frame, config_).first->second;
}

std::string EchoClocks::deskewedBy() const {
  if (clocks_.empty()) return "not known yet";
  if (clocks_.size() == 1) return clocks_.begin()->second.deskewedBy();
  std::string text;
  for (const auto& [frame, clock] : clocks_) text += (text.empty() ? "'" : "; '") + frame + "': " + clock.deskewedBy();
  return text;
}

void EchoClocks::reset() {
  for (auto& clock : clocks_) clock.second.reset();
}

}  // namespace donex
