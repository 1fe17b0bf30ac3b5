#include "ros/cloud_order.h"

#include <algorithm>
#include <functional>
#include <string_view>

namespace donex {
namespace {

/// Of a small cloud every byte counts. Of a larger one some of each part do, a prime apart, so that no column of an
/// organised cloud is left out: a cloud that differs from another of its stamp in a few echoes alone is not told from
/// it.
std::size_t contentOf(const sensor_msgs::PointCloud2& cloud) {
  constexpr std::size_t kSmall = 1U << 16U, kApart = 1021, kTaken = 16;  // bytes
  const auto* bytes = reinterpret_cast<const char*>(cloud.data.data());
  const std::hash<std::string_view> hash;
  if (cloud.data.size() <= kSmall) return hash({bytes, cloud.data.size()});
  std::size_t content = cloud.data.size();
  for (std::size_t at = 0; at + kTaken <= cloud.data.size(); at += kApart) {
    content = 31 * content + hash({bytes + at, kTaken});
  }
  return content;
}

/// A difference of ros::Time throws where it is beyond 68 years.
double secondsBetween(const ros::Time& from, const ros::Time& to) { return to.toSec() - from.toSec(); }

std::string cloudOf(const std_msgs::Header& header) {
  return "cloud of " + std::to_string(header.stamp.toSec()) + " s from '" + header.frame_id + "'";
}

}  // namespace

Arrival CloudOrder::judge(const sensor_msgs::PointCloud2& cloud) {
  const auto known = sensors_.find(cloud.header.frame_id);
  if (known != sensors_.end()) {
    const Sensor& sensor = known->second;
    if (isKnown(sensor, cloud)) return Arrival::kDuplicate;
    if (sensor.labeled && cloud.header.stamp < *sensor.labeled) return Arrival::kWentBack;
  }
  return behind(cloud);
}

bool CloudOrder::isKnown(const Sensor& sensor, const sensor_msgs::PointCloud2& cloud) {
  std::size_t alike = 0;
  std::optional<std::size_t> content;
  for (const Known& known : sensor.known) {
    if (known.stamp != cloud.header.stamp) continue;
    if (!content) content = contentOf(cloud);
    if (known.content == *content) {
      why_ = "a second " + cloudOf(cloud.header);
      return true;
    }
    ++alike;
  }
  if (alike < kMostOfOneStamp) return false;
  why_ = "stamps stand still: more than " + std::to_string(kMostOfOneStamp) + " times a " + cloudOf(cloud.header);
  return true;
}

/// Whether a cloud is too far behind what is labelled already.
Arrival CloudOrder::behind(const sensor_msgs::PointCloud2& cloud) {
  const ros::Time stamp = cloud.header.stamp;
  const double behind = newest_labeled_ ? secondsBetween(stamp, *newest_labeled_) : 0.0;
  if (behind <= kBetweenSensors) {
    other_since_.reset();
    return Arrival::kInTime;
  }
  why_ = cloudOf(cloud.header) + " is " + std::to_string(behind) +
         " s behind those of another sensor: their clocks differ, or it takes too long to come";
  other_since_ = std::min(stamp, other_since_.value_or(stamp));
  return secondsBetween(*other_since_, stamp) < kLeft ? Arrival::kOtherClock : Arrival::kClockIsLeft;
}

void CloudOrder::admit(const sensor_msgs::PointCloud2& cloud) {
  if (sensors_.size() >= kMostSensors && sensors_.count(cloud.header.frame_id) == 0) sensors_.clear();
  std::deque<Known>& known = sensors_[cloud.header.frame_id].known;
  const auto is_past = [&](const Known& other) {
    return secondsBetween(other.stamp, cloud.header.stamp) > kBetweenSensors;
  };
  while (!known.empty() && is_past(known.front())) known.pop_front();
  known.push_back({cloud.header.stamp, contentOf(cloud)});
}

void CloudOrder::labeled(const std_msgs::Header& header) {
  const auto latest = [&](std::optional<ros::Time>& time) {
    time = std::max(header.stamp, time.value_or(header.stamp));
  };
  latest(newest_labeled_);
  latest(sensors_[header.frame_id].labeled);
}

void CloudOrder::reset() {
  sensors_.clear();
  newest_labeled_.reset();
  other_since_.reset();
}

}  // namespace donex
