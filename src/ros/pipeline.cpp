#include "ros/pipeline.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "donex/memory_bound.h"
#include "donex/motion/deskew.h"
#include "donex/whole_drive.h"
#include "ros/parameters.h"

namespace donex {
namespace {

std::string cloudOf(const ros::Time& stamp) { return "cloud of " + std::to_string(stamp.toSec()) + " s"; }

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

Pipeline::Pipeline(const Config& config, const tf2::BufferCore& tf, PipelineEvents events)
    : Pipeline(config, tf, std::move(events), makeDetector(config)) {}

Pipeline::Pipeline(const Config& config, const tf2::BufferCore& tf, PipelineEvents events,
                   std::shared_ptr<Detector> detector)
    : config_(config),
      events_(std::move(events)),
      motion_(config.motion, tf),
      placer_(config, tf),
      given_(config),
      detector_(std::move(detector)),
      clocks_(config) {}

void Pipeline::addCloud(const sensor_msgs::PointCloud2ConstPtr& cloud, double now) {
  ++counts_.clouds_in;
  const LayoutVerdict verdict = judgeLayout(*cloud, config_.cloud);
  if (const auto* error = std::get_if<LayoutError>(&verdict)) return drop(DropReason::kBadLayout, error->text);

  WaitingCloud waiting{cloud, std::get<CloudLayout>(verdict), counts_.clouds_in, now, std::chrono::steady_clock::now()};
  observeTimes(waiting);
  switch (order_.judge(*cloud)) {
    case Arrival::kDuplicate: return drop(DropReason::kDuplicate, order_.why());
    case Arrival::kWentBack: return suspect(std::move(waiting));
    case Arrival::kOtherClock: return drop(DropReason::kOutOfOrder, order_.why());
    case Arrival::kClockIsLeft: startAnew("only clouds of another clock come: " + order_.why()); break;
    case Arrival::kInTime: dropSuspect(); break;
  }
  place(std::move(waiting));
}

void Pipeline::refuseCloud(const std::string& why) {
  ++counts_.clouds_in;
  drop(DropReason::kBadLayout, why);
}

/// A cloud that waits has perhaps been read in the unit before: it is read again.
void Pipeline::observeTimes(WaitingCloud& waiting) {
  EchoClock& clock = clockOf(waiting);
  if (!clock.observe(*waiting.cloud, waiting.layout)) return;
  parsed_ = 0;
  if (!clock.unitFinding().empty() && events_.unit_found) events_.unit_found(clock.unitFinding());
}

/// What the grid remembers was placed by times that meant something else.
void Pipeline::followTimes(const ScanMotion& motion, EchoClock& clock) {
  const bool is_told = (!motion.tracked || clock.isByAzimuth()) && !motion.sensor_from_cloud;
  if (!is_told || !clock.follow(scan_.stamp, motion.odom_from_base * motion.base_from_sensor)) return;
  parsed_ = 0;
  if (events_.reading_found) events_.reading_found(clock.readingFinding());
  if (needsWholeDrive(config_.method)) return;
  motion_.forgetClouds();
  reset();
  events_.forgotten("the meaning of the echoes' times has been found: the grid is forgotten");
}

void Pipeline::place(WaitingCloud cloud) {
  const ros::Time stamp = cloud.cloud->header.stamp;
  const auto later = [](const ros::Time& time, const WaitingCloud& other) { return time < other.cloud->header.stamp; };
  const auto place = std::upper_bound(waiting_.begin(), waiting_.end(), stamp, later);
  order_.admit(*cloud.cloud);
  waiting_.insert(place, std::move(cloud));
  while (isQueueTooLong()) {
    const ros::Time oldest = waiting_.front().cloud->header.stamp;
    waiting_.pop_front();
    drop(DropReason::kQueueFull, cloudOf(oldest) + " had to make room for newer ones");
  }
}

/// The clouds of a turn count as one scan, as long as they are together no larger than usual ones.
bool Pipeline::isQueueTooLong() const {
  const auto most = static_cast<std::size_t>(config_.node.queue_size);
  if (waiting_.size() <= most) return false;
  std::size_t echoes = 0;
  for (const WaitingCloud& waiting : waiting_) echoes += std::size_t{waiting.cloud->width} * waiting.cloud->height;
  return waiting_.size() > most * detector_->cloudsPerTurn() || echoes > most * kUsualScan;
}

void Pipeline::addOdometry(const nav_msgs::Odometry& odometry) {
  ++counts_.odometry_in;
  if (motion_.wantsOdometry()) use(odometry);
}

void Pipeline::use(const nav_msgs::Odometry& odometry) {
  const OdometryVerdict verdict = motion_.add(odometry);
  switch (verdict.kind) {
    case OdometryVerdict::Kind::kRefused: return refuse(verdict.refusal, verdict.text);
    case OdometryVerdict::Kind::kTimeRanBack: return suspect(odometry);
    case OdometryVerdict::Kind::kNewTrack:
      reset();
      events_.forgotten(verdict.text + ": the grid is forgotten");
      break;
    case OdometryVerdict::Kind::kUsed: break;
  }
  if (!suspect_odometry_) return;
  refuse(OdometryRefusal::kTooOld, "one odometry was much older than its neighbours");
  suspect_odometry_.reset();
}

void Pipeline::suspect(WaitingCloud cloud) {
  const bool is_second = suspect_cloud_ || suspect_odometry_;
  if (!is_second) {
    suspect_cloud_ = std::move(cloud);
    return;
  }
  startAnew("clouds went back to " + std::to_string(cloud.cloud->header.stamp.toSec()) + " s");
  place(std::move(cloud));
}

void Pipeline::suspect(const nav_msgs::Odometry& odometry) {
  const bool is_second = suspect_cloud_ || suspect_odometry_;
  if (!is_second) {
    suspect_odometry_ = odometry;
    return;
  }
  startAnew("odometry went back to " + std::to_string(odometry.header.stamp.toSec()) + " s");
  use(odometry);
}

void Pipeline::dropSuspect() {
  if (!suspect_cloud_) return;
  drop(DropReason::kOutOfOrder, cloudOf(suspect_cloud_->cloud->header.stamp) + " came after a later one was labelled");
  suspect_cloud_.reset();
}

void Pipeline::startAnew(const std::string& why) {
  const auto cloud = std::exchange(suspect_cloud_, std::nullopt);
  const auto odometry = std::exchange(suspect_odometry_, std::nullopt);
  for (const WaitingCloud& waiting : std::exchange(waiting_, {})) {
    drop(DropReason::kTimeRanBack, cloudOf(waiting.cloud->header.stamp) + " was waiting when time ran back");
  }
  motion_.reset();
  placer_.reset();
  reset();
  order_.reset();
  events_.forgotten("time ran back (" + why + "): buffers and grid are cleared");
  if (odometry) use(*odometry);
  if (cloud) place(*cloud);
}

bool Pipeline::step(double now) {
  if (waiting_.empty()) return false;
  WaitingCloud& oldest = waiting_.front();
  oldest.arrival = std::min(oldest.arrival, now);  // a clock set back must not make it wait for ever
  // What the motion comes from is chosen once, not for each cloud: of many small ones none may wait for so long.
  const bool is_chosen = motion_.source() != OdometrySource::kAuto;
  first_arrival_ = std::min(first_arrival_, oldest.arrival);
  const double since = is_chosen ? oldest.arrival : first_arrival_;
  const bool settle = now - since >= config_.motion.odometry_timeout;
  const MotionAnswer motion = motionOf(oldest, settle);
  const auto* missing = std::get_if<MotionMissing>(&motion);
  if (missing != nullptr && missing->may_come && !settle) return false;

  const WaitingCloud waiting = std::move(oldest);
  waiting_.pop_front();
  if (missing != nullptr) {
    drop(missing->reason, missing->text);
    return true;
  }
  try {
    label(waiting, std::get<ScanMotion>(motion));
    ++counts_.clouds_labeled;
  } catch (const std::exception& error) {
    drop(DropReason::kInternalError, error.what());
  }
  return true;
}

MotionAnswer Pipeline::motionOf(const WaitingCloud& waiting, bool settle) {
  const auto& header = waiting.cloud->header;
  try {
    parse(waiting);
    const bool was_known = motion_.source() != OdometrySource::kAuto;
    const std::string frame = placer_.movingFrame(header.frame_id, motion_.source());
    auto motion =
        motion_.during({header.stamp, times_.first, times_.last, &times_.after_stamp}, frame, settle, scan_.echoes);
    const bool is_chosen = !was_known && motion_.source() != OdometrySource::kAuto;
    if (is_chosen && events_.motion_chosen) events_.motion_chosen(motion_.choice());
    auto* known = std::get_if<ScanMotion>(&motion);
    if (known == nullptr) return motion;
    const auto nowhere = placer_.place(header.stamp, header.frame_id, motion_.source(), *known);
    return nowhere ? MotionAnswer(*nowhere) : motion;
  } catch (const std::exception& error) {
    // ros::Time throws where a time of the scan lies before 1970.
    return MotionMissing{DropReason::kInternalError, error.what(), false};
  }
}

void Pipeline::parse(const WaitingCloud& waiting) {
  if (parsed_ == waiting.number) return;
  const auto start = std::chrono::steady_clock::now();
  clockOf(waiting).read(*waiting.cloud, waiting.layout, scan_.echoes, times_);
  no_returns_ = removeNoReturns(originOf(waiting).cast<float>(), scan_.echoes);
  parsed_ = waiting.number;
  parsing_time_ = secondsSince(start);
}

void Pipeline::label(const WaitingCloud& waiting, const ScanMotion& motion) {
  const auto start = std::chrono::steady_clock::now();
  const auto& stamp = waiting.cloud->header.stamp;
  scan_.stamp = stamp.toSec();
  scan_.base_from_sensor = motion.base_from_sensor;
  scan_.odom_from_base = motion.odom_from_base;
  suspectOrigin(motion, waiting);
  if (motion.sensor_from_cloud) {
    const Eigen::Vector3d sensor = motion.sensor_from_cloud->inverse().translation();
    no_returns_ = removeNoReturns(sensor.cast<float>(), scan_.echoes);
    moveEchoes(*motion.sensor_from_cloud, scan_.echoes);
  }
  findSecondReturns(originOf(waiting).cast<float>());
  if (motion.track != nullptr) {
    const MotionFault fault =
        deskew(*motion.track, scan_.stamp, scan_.base_from_sensor, times_.after_stamp, scan_.echoes);
    if (fault != MotionFault::kNone) throw std::runtime_error(std::string("de-skewing: ") + describe(fault));
  }
  moveToOrigin(originOf(waiting));
  followTrack(motion);
  followOdometry(motion);
  completeOdometry(motion);
  // Behind another sensor's: where it was seen is its own time's, when it is learnt of is not.
  scan_.stamp = std::max(scan_.stamp, order_.newestLabeled().value_or(stamp).toSec());
  detector_->process(scan_, labels_);
  scan_.stamp = stamp.toSec();
  watchFlood();
  remark();
  tellSensor();
  motion_.learn(labels_.dynamic);
  order_.labeled(waiting.cloud->header);
  events_.labeled({waiting.cloud, waiting.layout, scan_, labels_, *detector_, motion.odom_frame, given_.odomFromWorld(),
                   motion, stamp.toSec() + times_.last, waiting.received, parsing_time_ + secondsSince(start)});
  given_.learn(labels_.dynamic);
  tellStrangeTimes(clockOf(waiting));
  followTimes(motion, clockOf(waiting));
}

/// Before de-skewing turns the two echoes of a beam into different directions.
void Pipeline::findSecondReturns(const Eigen::Vector3f& sensor) {
  scan_.second_returns = second_returns_.find(scan_.echoes, sensor);
  scan_.second_returns.resize(scan_.echoes.size(), 0);
}

/// Of a motion that is found in the clouds: what it says of itself.
void Pipeline::followTrack(const ScanMotion& motion) {
  if (!motion.tracked) return;
  if (motion.tracked->status == TrackingStatus::kDegenerate) ++counts_.degenerate;
  const bool is_another_track = motion.tracked->is_new_track && order_.newestLabeled();
  if (!is_another_track) return;
  reset();
  events_.forgotten("the ego motion was lost or not known yet, and is found anew in the clouds: the grid is forgotten");
}

/// What the grid remembers lies elsewhere after a jump: all of it would look new.
void Pipeline::followOdometry(const ScanMotion& motion) {
  const bool is_next = !order_.newestLabeled() || scan_.stamp > order_.newestLabeled()->toSec();
  if (!is_next) return;
  const double jump = given_.jumpBefore(scan_, motion, motion_.source());
  if (!(jump > 0.0)) return;
  ++counts_.jumps;
  reset();
  events_.forgotten("the odometry jumped by " + std::to_string(jump).substr(0, 4) + " m before the " +
                    cloudOf(ros::Time(scan_.stamp)) + ": the grid is forgotten");
}

/// Planar odometry has the vehicle drive on a plane while the ground it sees tilts.
void Pipeline::completeOdometry(const ScanMotion& motion) {
  if (!given_.complete(scan_, motion, motion_.source())) return;
  const bool is_news = counts_.completed++ == 0 && events_.odometry_completed;
  if (!is_news) return;
  events_.odometry_completed("the odometry never leaves its plane: height, roll and pitch are found in the clouds");
}

void Pipeline::tellStrangeTimes(EchoClock& clock) {
  if (!times_.problem.empty()) return events_.strange_times(times_.problem);
  if (clock.lacksToldField()) return events_.strange_times("de-skewed by " + clock.deskewedBy());
  const std::string lack = clock.untoldLack();
  if (!lack.empty() && events_.not_deskewed) events_.not_deskewed(lack);
}

void Pipeline::suspectOrigin(const ScanMotion& motion, const WaitingCloud& waiting) {
  const bool is_told = motion.sensor_from_cloud || !toldOrigin().isZero(0.0);
  const bool is_vehicle = motion.base_from_sensor.isApprox(Eigen::Isometry3d::Identity()) && !motion.tracked;
  if (is_told || !is_vehicle) return;
  const std::string strange = origin_watch_.follow(*waiting.cloud, waiting.layout, scan_.echoes);
  if (strange.empty()) return;
  if (events_.strange_origin) events_.strange_origin(strange);
  if (!originOf(waiting).isZero(0.0)) reset();  // the scans so far saw from another place
}

Eigen::Vector3d Pipeline::toldOrigin() const {
  return {config_.cloud.origin_x, config_.cloud.origin_y, config_.cloud.origin_z};
}

Eigen::Vector3d Pipeline::originOf(const WaitingCloud& waiting) const {
  const bool is_told = !toldOrigin().isZero(0.0);
  return is_told ? toldOrigin() : origin_watch_.foundIn(waiting.cloud->header.frame_id);
}

void Pipeline::watchFlood() {
  const double share = flood_.follow(scan_.stamp, labels_);
  if (!(share > 0.0)) return;
  ++counts_.floods;
  if (!events_.flooded) return;
  const std::string times = !times_.problem.empty() ? times_.problem : times_.empty() ? "none used" : "used";
  events_.flooded(std::to_string(static_cast<int>(100.0 * share)) + " % of the judged echoes of the " +
                  cloudOf(ros::Time(scan_.stamp)) +
                  " became dynamic at once, which is never the world; checked: jumps of the odometry (" +
                  std::to_string(counts_.jumps) + "), times of the echoes (" + times + ")");
}

/// Lines of sight begin in the origin of the scan's frame: in a merged cloud that is not where the sensor is.
void Pipeline::moveToOrigin(const Eigen::Vector3d& origin) {
  if (origin.isZero(0.0)) return;
  const Eigen::Vector3f shift = origin.cast<float>();
  for (Eigen::Vector3f& echo : scan_.echoes) echo -= shift;
  scan_.base_from_sensor.translate(origin);
}

void Pipeline::remark() {
  constexpr int kCertain = 10;  // scans in a row; a lorry alongside hides the ground for a few
  without_ground_ = detector_->lacksGround() ? std::min(without_ground_ + 1, kCertain) : 0;
  remarks_ = remarksOn(scan_, no_returns_, config_.region, times_.wild, without_ground_ == kCertain);
  for (std::size_t kind = 0; kind < kCloudRemarks; ++kind) {
    const bool is_news = !remarks_[kind].empty() && !remarked_[kind];
    if (!is_news) continue;
    remarked_[kind] = true;
    if (events_.remarked) events_.remarked(static_cast<CloudRemark>(kind), remarks_[kind]);
  }
}

void Pipeline::tellSensor() {
  if (is_sensor_told_) return;
  const std::optional<MeasuredSensor> sensor = detector_->measuredSensor();
  is_sensor_told_ = sensor.has_value();
  if (sensor && events_.sensor_measured) events_.sensor_measured(describe(*sensor));
}

void Pipeline::finish() {
  while (step(std::numeric_limits<double>::infinity())) {
  }
  dropSuspect();
}

void Pipeline::reset() {
  clocks_.reset();
  given_.reset();
  detector_->reset();
  second_returns_.reset();
  flood_.reset();
}

void Pipeline::watchCells(bool watched) {
  if (watched == watched_) return;
  watched_ = watched;
  detector_->watch(watched);
}

void Pipeline::configure(const Config& config) {
  const auto faults = faultsOf(config);
  if (!faults.empty()) throw std::invalid_argument(joined(faults));
  if (!sameDetection(config_, config)) {
    detector_ = makeDetector(config);
    detector_->watch(watched_);
  }
  const MotionConfig motion = config_.motion;
  config_ = config;
  config_.motion = motion;
}

void Pipeline::refuse(OdometryRefusal refusal, const std::string& text) {
  counts_.refused.add(refusal);
  events_.refused(refusal, text);
}

void Pipeline::drop(DropReason reason, const std::string& text) {
  counts_.dropped.add(reason);
  events_.dropped(reason, text);
}

}  // namespace donex
