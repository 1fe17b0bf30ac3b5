#include "core/motion/odometry_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/pi.h"

namespace donex {
namespace {

template <class... Values>
std::string textOf(const char* format, Values... values) {
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

std::string textOf(const TrackDifference& difference) {
  return textOf("%.2f m and %.2f degrees over %.0f m", difference.distance, std::abs(difference.yaw) * 180.0 / kPi,
                difference.way);
}

}  // namespace

const char* describe(Agreement agreement) {
  switch (agreement) {
    case Agreement::kTooEarly: return "not enough scans yet";
    case Agreement::kAgrees: return "agrees";
    case Agreement::kDisagrees: return "disagrees";
    case Agreement::kCannotTell: break;
  }
  return "cannot tell: the scans leave their own motion open";
}

std::string describe(const OdometryFinding& finding) {
  switch (finding.agreement) {
    case Agreement::kAgrees: return "odometry agrees with the scans within " + textOf(finding.difference);
    case Agreement::kDisagrees:
      return "odometry disagrees with the scans by " + textOf(finding.difference) +
             "; likely cause: " + describe(finding.cause);
    default: return std::string("odometry against the scans: ") + describe(finding.agreement);
  }
}

std::string summaryOf(const OdometryFinding& finding) {
  if (finding.windows == 0) return std::string("odometry against the scans: ") + describe(finding.agreement);
  if (finding.harmful == 0) return "odometry agrees with the scans within " + textOf(finding.largest);
  return textOf("odometry disagrees with the scans in %zu of %zu windows, first at scan %zu, by up to ",
                finding.harmful, finding.windows, finding.alarm_scan) +
         textOf(finding.largest) + "; likely cause: " + describe(finding.cause);
}

void OdometryCheck::reset() {
  odometry_.reset();
  scans_.clear();
  finding_ = OdometryFinding();
  until_cause_ = 0;
}

const OdometryFinding& OdometryCheck::check(const ScanInQuestion& scan) {
  const double elapsed = scans_.empty() ? 0.0 : scan.stamp - scans_.back().stamp;
  const bool breaks_off = elapsed < 0.0 || elapsed > options_.longest_gap;
  if (breaks_off) {
    odometry_.reset();
    scans_.clear();
  }
  const TrackedScan& tracked = odometry_.locate(scan.stamp, scan.echoes);
  ++finding_.scans;
  finding_.jump = 0.0;
  const bool is_open = tracked.status == TrackingStatus::kDegenerate || tracked.status == TrackingStatus::kLost;
  if (is_open || tracked.is_new_track) scans_.clear();
  if (is_open) {
    ++finding_.untold;
    finding_.agreement = Agreement::kCannotTell;
    return finding_;
  }
  scans_.push_back({scan.stamp, scan.odom_from_base,
                    scan.base_from_sensor * tracked.odom_from_sensor * scan.base_from_sensor.inverse()});
  if (scans_.size() > options_.history) scans_.pop_front();
  tellJump();
  compare();
  return finding_;
}

void OdometryCheck::compare() {
  const std::size_t most = std::min(scans_.size(), options_.window.most_scans + 1);
  Poses given, found;
  for (auto scan = scans_.end() - static_cast<std::ptrdiff_t>(most); scan != scans_.end(); ++scan) {
    given.push_back(scan->given);
    found.push_back(scan->found);
  }
  std::size_t first = 0;
  if (!windowBefore(found, most - 1, options_.window, first)) {
    if (finding_.agreement != Agreement::kCannotTell) finding_.agreement = Agreement::kTooEarly;
    return;
  }
  finding_.difference = differenceBetween(given, found, first, most - 1);
  ++finding_.windows;
  const bool is_largest = finding_.windows == 1 || finding_.difference.harm() > finding_.largest.harm();
  if (is_largest) finding_.largest = finding_.difference;
  const bool is_harmful = finding_.difference.harm() > 1.0;
  finding_.agreement = is_harmful ? Agreement::kDisagrees : Agreement::kAgrees;
  if (until_cause_ > 0) --until_cause_;
  if (!is_harmful) return;
  if (finding_.harmful++ == 0) finding_.alarm_scan = finding_.scans - 1;
  if (until_cause_ > 0) return;
  const auto newest = static_cast<std::ptrdiff_t>(std::min(scans_.size(), options_.cause_scans));
  finding_.cause = findCause({scans_.end() - newest, scans_.end()}, options_.window, options_.is_twist);
  until_cause_ = options_.cause_period;
}

/// A single step that is off; an odometry that is off in all of them does not jump.
void OdometryCheck::tellJump() {
  constexpr std::size_t kBefore = 5;  // scans that have to agree
  if (scans_.size() < kBefore + 2) return;
  const auto isOff = [&](std::size_t back) {
    const ComparedScan& from = scans_[scans_.size() - 2 - back];
    const ComparedScan& to = scans_[scans_.size() - 1 - back];
    return differenceBetween({from.given, to.given}, {from.found, to.found}, 0, 1).distance;
  };
  for (std::size_t back = 1; back <= kBefore; ++back) {
    if (isOff(back) > options_.jump) return;
  }
  const double size = isOff(0);
  if (size <= options_.jump) return;
  finding_.jump = size;
  ++finding_.jumps;
}

void OdometryCheck::learn(const std::vector<std::uint8_t>& dynamic) {
  const auto moving = static_cast<double>(std::count(dynamic.begin(), dynamic.end(), 1));
  const bool is_flooded = moving > options_.flooded * static_cast<double>(dynamic.size());
  if (!is_flooded) odometry_.learn(dynamic);
}

}  // namespace donex
