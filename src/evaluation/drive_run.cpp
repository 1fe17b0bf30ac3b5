#include "evaluation/drive_run.h"

#include <algorithm>

#include "core/timing.h"

namespace donex {
namespace {

constexpr double kUsualDuration = 0.1;    // [s] of a scan without another one
constexpr double kLongestDuration = 0.2;  // [s] sensors that turn slower are not known: scans are missing

/// A scan lasts until the next one; the last one as long as the one before.
double durationOf(const SequenceReader& sequence, std::size_t index) {
  if (sequence.size() < 2) return kUsualDuration;
  const std::size_t first = std::min(index, sequence.size() - 2);
  return std::min(sequence.stamp(first + 1) - sequence.stamp(first), kLongestDuration);
}

}  // namespace

DriveRun::DriveRun(const Config& config, DriveOdometry odometry) {
  if (odometry == DriveOdometry::kLidar) {
    odometry_.emplace();
  } else {
    if (config.motion.odometry_check) check_.emplace();
    if (config.motion.odometry_refine) completion_.emplace();
  }
  if (needsWholeDrive(config.method)) {
    whole_ = makeWholeDriveDetector(config);
  } else {
    live_ = makeDetector(config);
  }
}

void DriveRun::judge(const Scan& scan, std::size_t index, double duration) {
  const bool is_cut = parts_.count() > 1;
  if (is_cut) {
    parts_.cut(scan, duration);
    labels_.resize(scan.echoes.size());
  }
  const double wall = wallTime();
  const double cpu = cpuTime();
  if (is_cut) {
    for (std::size_t k = 0; k < parts_.count(); ++k) {
      detector().process(parts_[k], labels_of_part_);
      parts_.putBack(k, labels_of_part_, labels_);
    }
  } else {
    detector().process(scan, labels_);
  }
  cpu_times_[index] += cpuTime() - cpu;
  times_[index] += wallTime() - wall;
}

/// A drive that is shown again has its poses from the first time.
void DriveRun::locate(Scan& scan, std::size_t index) {
  if (index == tracked_.size()) {
    const double start = cpuTime();
    tracked_.push_back(odometry_->locate(scan.stamp, scan.echoes));
    odometry_times_.push_back(cpuTime() - start);
    const bool is_another_track = index > 0 && tracked_.back().is_new_track;
    if (is_another_track && live_ != nullptr) live_->reset();
  }
  scan.odom_from_base = tracked_[index].odom_from_sensor;
}

void DriveRun::learn(std::size_t index) {
  const bool is_newest = live_ != nullptr && index + 1 == tracked_.size();
  if (!is_newest) return;
  const double start = cpuTime();
  odometry_->learn(labels_.dynamic);
  odometry_times_[index] += cpuTime() - start;
}

void DriveRun::followPoses(const Scan& scan) {
  if (!(jump_.follow(scan.stamp, scan.odom_from_base) > 0.0)) return;
  ++jumps_;
  if (completion_) completion_->reset();
  live_->reset();
}

/// A drive that is shown again has its poses from the first time.
void DriveRun::complete(Scan& scan, std::size_t index) {
  if (index == completed_poses_.size()) {
    const double start = cpuTime();
    completed_poses_.push_back(completion_->complete(scan.stamp, scan.echoes, scan.base_from_sensor, scan.odom_from_base));
    if (completion_->isActive()) {
      ++completed_;
      odometry_times_.push_back(cpuTime() - start);
    }
  }
  scan.odom_from_base = completed_poses_[index];
}

/// The poses given, as a node checks those of its odometry; once, however often the drive is shown.
void DriveRun::compare(const Scan& scan, const Eigen::Isometry3d& given, std::size_t index) {
  if (index != checked_) return;
  ++checked_;
  check_->check({scan.stamp, scan.echoes, scan.base_from_sensor, given});
  if (live_ != nullptr) check_->learn(labels_.dynamic);
}

void DriveRun::run(const SequenceReader& sequence, std::size_t scans, const Sink& sink,
                   const std::function<void()>& progress) {
  times_.assign(scans, 0.0);
  cpu_times_.assign(scans, 0.0);
  do {
    const bool counts = whole_ == nullptr || whole_->isLastPass();
    for (std::size_t i = 0; i < scans; ++i) {
      Scan scan = toScan(sequence.scan(i));
      if (odometry_) locate(scan, i);
      if (check_ && live_ != nullptr) followPoses(scan);
      const Eigen::Isometry3d given = scan.odom_from_base;
      if (completion_) complete(scan, i);
      judge(scan, i, durationOf(sequence, i));
      if (odometry_) learn(i);
      if (completion_ && live_ != nullptr) completion_->learn(labels_.dynamic);
      if (check_) compare(scan, given, i);
      if (counts) sink(i, scan, labels_);
      progress();
    }
  } while (whole_ != nullptr && whole_->nextPass());
}

}  // namespace donex
