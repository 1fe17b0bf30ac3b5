#include "ros/odometry_monitor.h"

#include <limits>
#include <utility>

#include "ros/cloud_placer.h"
#include "ros/conversions.h"

namespace donex {
namespace {

OdometryCheck::Options optionsFor(const MotionConfig& config, bool keep_all) {
  OdometryCheck::Options options;
  if (keep_all) options.history = std::numeric_limits<std::size_t>::max();
  options.is_twist = config.source == OdometrySource::kTwist;
  return options;
}

}  // namespace

bool isChecked(const MotionConfig& config, OdometrySource source) {
  const bool is_told =
      source == OdometrySource::kPose || source == OdometrySource::kTwist || source == OdometrySource::kTf;
  return config.odometry_check && is_told;
}

bool OneSensor::isIt(const std::string& frame) {
  const bool is_gone = frame_.empty() || ++others_ > kGone;
  if (is_gone) frame_ = frame;
  if (frame == frame_) others_ = 0;
  return frame == frame_;
}

LabeledScanCheck::LabeledScanCheck(const MotionConfig& config, bool keep_all) : check_(optionsFor(config, keep_all)) {}

LabeledScanCheck::Question LabeledScanCheck::questionOf(const LabeledScan& scan) {
  const ScanMotion& motion = scan.motion;
  return {scan.cloud,          scan.layout,        motion.midway, motion.base_from_sensor, motion.sensor_from_cloud,
          motion.track_number, scan.labels.dynamic};
}

const OdometryFinding& LabeledScanCheck::check(const Question& question) {
  const bool is_another_track = track_ && *track_ != question.track;
  if (is_another_track) check_.forgetOdometry();
  track_ = question.track;
  parseEchoes(*question.cloud, question.layout, echoes_);
  if (question.sensor_from_cloud) moveEchoes(*question.sensor_from_cloud, echoes_);
  const OdometryFinding& finding =
      check_.check({question.moment.stamp, echoes_, question.base_from_sensor, question.moment.odom_from_base});
  check_.learn(question.dynamic);
  return finding;
}

OdometryMonitor::OdometryMonitor(const MotionConfig& config, Tell tell)
    : check_(config), tell_(std::move(tell)), thread_([this] { run(); }) {}

OdometryMonitor::~OdometryMonitor() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void OdometryMonitor::add(const LabeledScan& scan) {
  if (!sensor_.isIt(scan.cloud->header.frame_id)) return;
  auto question = LabeledScanCheck::questionOf(scan);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    waiting_ = std::move(question);
  }
  changed_.notify_one();
}

void OdometryMonitor::run() {
  while (true) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return ends_ || waiting_.has_value(); });
    if (ends_) return;
    const LabeledScanCheck::Question question = std::move(*waiting_);
    waiting_.reset();
    lock.unlock();
    tell_(check_.check(question));
  }
}

}  // namespace donex
