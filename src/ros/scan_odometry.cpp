#include "ros/scan_odometry.h"

#include <algorithm>

namespace donex {
namespace {

/// The echoes of a slow turn that comes in parts end this long after the middle of the turn before [s].
constexpr double kLongestScan = 0.4;
constexpr double kStands = 0.05;    // [m] and
constexpr double kLooksOn = 0.005;  // [rad]: a motion within a turn that places hardly an echo in another voxel
constexpr double kWide = 0.6;       // of all azimuths: what sees so much tells enough by itself
constexpr std::size_t kMostOfTurn = 1'000'000;  // echoes and clouds that are kept until a turn is over
constexpr int kCertain = 20;                    // clouds in a row that were turns: nobody is asked any more

EgoMotion::Options trackOptions() {
  EgoMotion::Options options;
  options.max_extrapolation = kLongestScan;
  return options;
}

}  // namespace

ScanOdometry::ScanOdometry() : track_(trackOptions()) {}

const TrackedScan& ScanOdometry::locate(double stamp, const std::vector<Eigen::Vector3f>& echoes,
                                        const std::vector<float>& times, const Eigen::Isometry3d& base_from_sensor) {
  if (!base_from_first_) base_from_first_ = base_from_sensor;
  const std::vector<Eigen::Vector3f>& moved = asFirstSensor(echoes, base_from_sensor);
  const TurnPart part = partOf(stamp, echoes, base_from_sensor);
  const bool may_be_part = clouds_++ == 0 && !is_wide_;
  is_whole_ = part == TurnPart::kWhole;
  tracked_.is_new_track = false;
  if (is_whole_) {
    turn_.clear();
    follow(odometry_.locate(stamp, moved, times));
  } else if (part == TurnPart::kFirst) {
    registerTurn();
  } else if (clouds_ == 2 && !turn_.empty()) {
    forgetTrack();  // what the first part alone has begun
  }
  in_turn_ = turn_.empty() ? 0 : in_turn_ + moved.size() + 1;
  const bool has_room = in_turn_ < kMostOfTurn;
  if (has_room && (!is_whole_ || may_be_part)) turn_.push_back({stamp, moved, times, {}});
  stamp_ = stamp;
  odom_from_base_ = odomFromBaseAt(stamp);
  return tracked_;
}

void ScanOdometry::forgetTrack() {
  odometry_.reset();
  track_.reset();
  tracked_ = TrackedScan();
  tracked_.is_new_track = false;
}

TurnPart ScanOdometry::partOf(double stamp, const std::vector<Eigen::Vector3f>& echoes,
                              const Eigen::Isometry3d& base_from_sensor) {
  if (whole_in_a_row_ >= kCertain) return TurnPart::kWhole;
  is_echo_.clear();
  for (const Eigen::Vector3f& echo : echoes) is_echo_.push_back(echo.allFinite() ? 1 : 0);
  pixels_.project(echoes, is_echo_);
  Scan scan;
  scan.stamp = stamp;
  scan.base_from_sensor = base_from_sensor;
  const TurnPart arrived = turns_.arrive(scan, pixels_);
  const auto columns = std::count(turns_.newest().begin(), turns_.newest().end(), 1);
  is_wide_ = static_cast<double>(columns) > kWide * static_cast<double>(turns_.newest().size());
  const TurnPart part = is_wide_ ? TurnPart::kWhole : arrived;
  whole_in_a_row_ = part == TurnPart::kWhole ? whole_in_a_row_ + 1 : 0;
  return part;
}

/// As one scan, whose echoes have times of their own.
void ScanOdometry::registerTurn() {
  if (turn_.empty()) return;
  merged_ = Part();
  merged_.stamp = turn_.back().stamp;
  for (Part& part : turn_) {
    const auto after = static_cast<float>(part.stamp - merged_.stamp);
    part.times.resize(part.echoes.size(), 0.0F);
    part.dynamic.resize(part.echoes.size(), 0);
    merged_.echoes.insert(merged_.echoes.end(), part.echoes.begin(), part.echoes.end());
    merged_.dynamic.insert(merged_.dynamic.end(), part.dynamic.begin(), part.dynamic.end());
    for (const float time : part.times) merged_.times.push_back(after + time);
  }
  turn_.clear();
  const bool begins = track_.empty();
  const Eigen::Isometry3d before = odomFromBaseAt(merged_.stamp);
  follow(odometry_.locate(merged_.stamp, merged_.echoes, merged_.times));
  odometry_.learn(merged_.dynamic);
  if (begins) tracked_.is_new_track = false;  // it began with the turn's first part
  // Until the second turn is over the vehicle was taken to stand.
  const Eigen::Isometry3d error = before.inverse() * odomFromBaseAt(merged_.stamp);
  const bool has_moved = error.translation().norm() > kStands || Eigen::AngleAxisd(error.linear()).angle() > kLooksOn;
  if (!begins && tracked_.status == TrackingStatus::kStarting && has_moved) tracked_.is_new_track = true;
}

void ScanOdometry::follow(const TrackedScan& tracked) {
  tracked_ = tracked;
  if (tracked_.is_new_track) track_.reset();
  OdometrySample sample;
  sample.stamp = tracked_.moment;
  // The odometry frame is where the vehicle was at the start, not the sensor.
  sample.odom_from_base = *base_from_first_ * tracked_.odom_from_sensor * base_from_first_->inverse();
  track_.add(sample);
}

/// In a turn the pose at the stamp is another one than in the middle of the scan.
Eigen::Isometry3d ScanOdometry::odomFromBaseAt(double stamp) const {
  if (track_.empty()) return Eigen::Isometry3d::Identity();
  const auto at_stamp = track_.poseAt(stamp);
  return at_stamp ? *at_stamp : *base_from_first_ * tracked_.odom_from_sensor * base_from_first_->inverse();
}

void ScanOdometry::learn(const std::vector<std::uint8_t>& dynamic) {
  if (is_whole_) odometry_.learn(dynamic);
  const bool is_kept = !turn_.empty() && turn_.back().echoes.size() == dynamic.size();
  if (is_kept) turn_.back().dynamic = dynamic;
}

const std::vector<Eigen::Vector3f>& ScanOdometry::asFirstSensor(const std::vector<Eigen::Vector3f>& echoes,
                                                                const Eigen::Isometry3d& base_from_sensor) {
  if (base_from_sensor.isApprox(*base_from_first_)) return echoes;
  const Eigen::Isometry3f first_from_sensor = (base_from_first_->inverse() * base_from_sensor).cast<float>();
  moved_.clear();
  for (const Eigen::Vector3f& echo : echoes) moved_.push_back(first_from_sensor * echo);
  return moved_;
}

void ScanOdometry::reset() {
  base_from_first_.reset();
  forgetTrack();
  turns_.reset();
  turn_.clear();
  clouds_ = 0;
  whole_in_a_row_ = 0;
  odom_from_base_.setIdentity();
}

}  // namespace donex
