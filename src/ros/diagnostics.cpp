#include "ros/diagnostics.h"

#include <fstream>

#include <unistd.h>

#include "core/timing.h"

namespace donex {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;
using Clock = Diagnostics::Clock;

constexpr std::chrono::seconds kWindow{5};  // over which rates and times are taken

double seconds(Clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

/// Arrivals per second over the window.
double rateOf(const std::deque<Clock::time_point>& times) {
  if (times.size() < 2) return 0.0;
  const double span = seconds(times.back() - times.front());
  return span > 0.0 ? static_cast<double>(times.size() - 1) / span : 0.0;
}

template <class Entries, class TimeOf>
void forgetOld(Entries& entries, const TimeOf& time_of) {
  const Clock::time_point horizon = Clock::now() - kWindow;
  while (!entries.empty() && time_of(entries.front()) < horizon) entries.pop_front();
}

double residentMegabytes() {
  std::ifstream statm("/proc/self/statm");
  double total = 0.0, resident = 0.0;
  statm >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

}  // namespace

Diagnostics::Diagnostics(const ros::NodeHandle& nh, const ros::NodeHandle& pnh, const Pipeline& pipeline,
                         bool needs_odometry)
    : pipeline_(pipeline), updater_(nh, pnh, pnh.getNamespace()), needs_odometry_(needs_odometry) {
  updater_.setHardwareID("none");
  updater_.add("classifier", this, &Diagnostics::report);
}

void Diagnostics::cloudArrived(const ros::Time& stamp) {
  last_cloud_ = Clock::now();
  newest_cloud_ = stamp;
  arrivals_.push_back(*last_cloud_);
}

void Diagnostics::odometryArrived(const ros::Time& stamp) {
  last_odometry_ = Clock::now();
  newest_odometry_ = stamp;
  odometry_arrivals_.push_back(*last_odometry_);
}

void Diagnostics::scanPublished(const LabeledScan& scan) {
  const auto now = Clock::now();
  published_.push_back(
      {now, scan.processing_time, seconds(now - scan.received), ros::Time::now().toSec() - scan.last_echo});
  if (scan.motion.tracked) tracking_ = describe(scan.motion.tracked->status);
}

void Diagnostics::dropped(DropReason reason, const std::string& text) {
  drops_.push_back(Clock::now());
  last_reason_ = reason;
  last_drop_ = text;
}

void Diagnostics::odometryChecked(const OdometryFinding& finding) {
  const std::lock_guard<std::mutex> lock(checked_mutex_);
  checked_ = finding;
}

std::optional<OdometryFinding> Diagnostics::checked() const {
  const std::lock_guard<std::mutex> lock(checked_mutex_);
  return checked_;
}

std::string Diagnostics::odometryText() const {
  const auto found = checked();
  return found ? describe(*found) : "odometry is not checked against the scans";
}

void Diagnostics::report(DiagnosticStatusWrapper& status) {
  const auto itself = [](const Clock::time_point& time) { return time; };
  forgetOld(arrivals_, itself);
  forgetOld(odometry_arrivals_, itself);
  forgetOld(drops_, itself);
  forgetOld(published_, [](const Figures& figures) { return figures.published; });
  addLine(status);
  addFigures(status);
  addCounts(status);
  addCheck(status);
  failures_reported_ = failures_;
}

Health Diagnostics::health() const {
  const auto now = Clock::now();
  Health health;
  health.labeled_rate = publishedRate();
  health.median_time = medianProcessing();
  if (last_cloud_) health.silent = seconds(now - *last_cloud_);
  health.needs_odometry = needs_odometry_;
  if (last_odometry_) health.odometry_age = seconds(now - *last_odometry_);
  health.drops = drops_.size();
  health.last_drop = describe(last_reason_);
  health.region_fault = remarkOf(pipeline_.remarks(), CloudRemark::kRegionMissed);
  health.waiting = pipeline_.waiting();
  const auto found = checked();
  if (found && found->agreement == Agreement::kDisagrees) health.odometry_fault = describe(found->cause);
  if (failures_ != failures_reported_) health.failure = last_failure_;
  return health;
}

void Diagnostics::addLine(DiagnosticStatusWrapper& status) const {
  const HealthLine line = tell(health());
  switch (line.level) {
    case HealthLine::Level::kOk: return status.summary(DiagnosticStatus::OK, line.text);
    case HealthLine::Level::kWarn: return status.summary(DiagnosticStatus::WARN, line.text);
    case HealthLine::Level::kError: return status.summary(DiagnosticStatus::ERROR, line.text);
  }
}

double Diagnostics::publishedRate() const {
  Times times;
  for (const Figures& figures : published_) times.push_back(figures.published);
  return rateOf(times);
}

double Diagnostics::medianProcessing() const {
  std::vector<double> values;
  for (const Figures& figures : published_) values.push_back(figures.processing);
  return quantile(values, 0.5);
}

void Diagnostics::addFigures(DiagnosticStatusWrapper& status) const {
  std::vector<double> processing, latency, since_last_echo;
  for (const Figures& figures : published_) {
    processing.push_back(figures.processing);
    latency.push_back(figures.latency);
    since_last_echo.push_back(figures.since_last_echo);
  }
  status.addf("clouds in [Hz]", "%.2f", rateOf(arrivals_));
  status.addf("clouds labelled [Hz]", "%.2f", publishedRate());
  status.addf("odometry in [Hz]", "%.2f", rateOf(odometry_arrivals_));
  const bool both = last_cloud_ && last_odometry_;
  status.addf("odometry behind the clouds [s]", "%.3f", both ? (newest_cloud_ - newest_odometry_).toSec() : 0.0);
  status.addf("time a scan, median [ms]", "%.2f", 1e3 * quantile(processing, 0.5));
  status.addf("time a scan, p99 [ms]", "%.2f", 1e3 * quantile(processing, 0.99));
  status.addf("latency in to out, median [ms]", "%.2f", 1e3 * quantile(latency, 0.5));
  status.addf("latency in to out, p99 [ms]", "%.2f", 1e3 * quantile(latency, 0.99));
  status.addf("latency last echo to labels, median [ms]", "%.2f", 1e3 * quantile(since_last_echo, 0.5));
  status.addf("latency last echo to labels, p99 [ms]", "%.2f", 1e3 * quantile(since_last_echo, 0.99));
  status.addf("memory of the grid [MB]", "%.1f", static_cast<double>(pipeline_.detector().memoryBytes()) / 1e6);
  status.addf("memory of the process [MB]", "%.1f", residentMegabytes());
}

void Diagnostics::addCounts(DiagnosticStatusWrapper& status) const {
  const PipelineCounts& counts = pipeline_.counts();
  status.add("clouds in", counts.clouds_in);
  status.add("clouds labelled", counts.clouds_labeled);
  status.add("clouds waiting", pipeline_.waiting());
  status.add("clouds dropped", counts.dropped.total());
  for (std::size_t i = 0; i < kDropReasons; ++i) {
    const auto reason = static_cast<DropReason>(i);
    status.add(std::string("dropped: ") + describe(reason), counts.dropped.of(reason));
  }
  status.add("ego motion from", nameOf(pipeline_.motion().source()));
  if (!tracking_.empty()) {
    status.add("ego motion from the clouds", tracking_);
    status.add("clouds labelled, ego motion open in part", counts.degenerate);
  }
  status.add("odometry in", counts.odometry_in);
  for (std::size_t i = 0; i < kOdometryRefusals; ++i) {
    const auto refusal = static_cast<OdometryRefusal>(i);
    status.add(std::string("odometry refused: ") + describe(refusal), counts.refused.of(refusal));
  }
  status.add("odometry jumps", counts.jumps);
  status.add("clouds labelled, height, roll and pitch from the clouds", counts.completed);
  status.add("alarms: what stands became dynamic at once", counts.floods);
  if (!last_flood_.empty()) status.add("last such alarm", last_flood_);
  for (std::size_t i = 0; i < kCloudRemarks; ++i) {
    const auto kind = static_cast<CloudRemark>(i);
    status.add(describe(kind), remarkOf(pipeline_.remarks(), kind));
  }
  status.add("last drop", last_drop_);
  const std::optional<MeasuredSensor> sensor = pipeline_.detector().measuredSensor();
  status.add("the sensor", sensor ? describe(*sensor) : "not measured");
  status.add("de-skewed by", pipeline_.deskewedBy());
  status.add("unit of the echo times", found_unit_);
  status.add("last echo times not used", last_strange_times_);
  if (!strange_origin_.empty()) status.add("origin of the clouds", strange_origin_);
  status.add("last odometry refused", last_refusal_);
  status.add("internal errors", failures_);
  status.add("last internal error", last_failure_);
}

void Diagnostics::addCheck(DiagnosticStatusWrapper& status) const {
  const auto found = checked();
  if (!found) return;
  status.add("odometry against the scans", describe(*found));
  status.add("windows checked", found->windows);
  status.add("windows in which odometry and scans disagree", found->harmful);
}

}  // namespace donex
