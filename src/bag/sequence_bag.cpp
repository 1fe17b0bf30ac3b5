#include "bag/sequence_bag.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <nav_msgs/Odometry.h>
#include <tf2_eigen/tf2_eigen.h>
#include <tf2_msgs/TFMessage.h>

#include "bag/bag_file.h"
#include "evaluation/scan_parts.h"
#include "io/number_text.h"
#include "ros/cloud_fields.h"

namespace donex {
namespace {

constexpr const char* kOdomFrame = "odom";
constexpr const char* kBaseFrame = "base_link";
constexpr const char* kSensorFrame = "velodyne";

/// Between messages of the same stamp: at equal times a bag's reader takes any order.
const ros::Duration kStep(0, 1000);

nav_msgs::Odometry toOdometry(const OdometryPoint& point) {
  nav_msgs::Odometry message;
  message.header.stamp = ros::Time(point.stamp);
  message.header.frame_id = kOdomFrame;
  message.child_frame_id = kBaseFrame;
  message.pose.pose.position = tf2::toMsg(point.odom_from_base.position);
  message.pose.pose.orientation = tf2::toMsg(point.odom_from_base.orientation);
  tf2::toMsg(point.twist.linear, message.twist.twist.linear);
  tf2::toMsg(point.twist.angular, message.twist.twist.angular);
  return message;
}

tf2_msgs::TFMessage toTransform(double stamp, const std::string& parent, const std::string& child, const Pose& pose) {
  tf2_msgs::TFMessage message;
  message.transforms.resize(1);
  geometry_msgs::TransformStamped& transform = message.transforms.front();
  transform.header.stamp = ros::Time(stamp);
  transform.header.frame_id = parent;
  transform.child_frame_id = child;
  tf2::toMsg(pose.position, transform.transform.translation);
  transform.transform.rotation = tf2::toMsg(pose.orientation);
  return message;
}

void writeOdometry(BagWriter& bag, const OdometryPoint& point) {
  const ros::Time stamp(point.stamp);
  bag.write("/odom", stamp, toOdometry(point));
  bag.write("/tf", stamp + kStep, toTransform(point.stamp, kOdomFrame, kBaseFrame, point.odom_from_base));
}

/// Whole seconds, so that the fractions of the stamps stay.
double shiftFor(double earliest) { return earliest >= 1.0 ? 0.0 : 1.0 - std::floor(earliest); }

std::vector<OdometryPoint> odometryOf(const SequenceReader& sequence, const OdometryRhythm& rhythm) {
  std::vector<double> stamps;
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    stamps.push_back(sequence.stamp(i));
    poses.push_back(sequence.pose(i));
  }
  return odometryAlong(stamps, poses, rhythm);
}

/// Times in other units than seconds would fill memory with odometry.
void checkTimes(const SequenceReader& sequence, double odometry_rate) {
  constexpr double kEndOfTime = 4294967295.0;  // seconds are 32 bits in ROS
  constexpr double kMostMessages = 1e7;
  const double first = sequence.stamp(0), last = sequence.stamp(sequence.size() - 1);
  const std::string times = fmt::format("{}: the times run from {} to {} s", sequence.directory().string(),
                                        numberText(first), numberText(last));
  if (last + shiftFor(first) >= kEndOfTime) throw DataError(times + ", beyond what ROS can hold");
  if ((last - first) * odometry_rate > kMostMessages) throw DataError(times + ", too long for this rate of odometry");
}

/// Until the next scan; the last one took as long as the one before [s].
double durationOf(const SequenceReader& sequence, std::size_t scan) {
  if (sequence.size() < 2) return 0.0;
  const std::size_t first = std::min(scan, sequence.size() - 2);
  return sequence.stamp(first + 1) - sequence.stamp(first);
}

SequenceScan partOf(const SequenceScan& scan, const std::vector<std::uint32_t>& echoes) {
  SequenceScan part;
  part.stamp = scan.stamp;
  for (const std::uint32_t echo : echoes) {
    part.echoes.push_back(scan.echoes[echo]);
    part.intensities.push_back(scan.intensities[echo]);
  }
  return part;
}

}  // namespace

sensor_msgs::PointCloud2Ptr toCloud(const SequenceScan& scan) {
  std_msgs::Header header;
  header.stamp = ros::Time(scan.stamp);
  header.frame_id = kSensorFrame;
  auto cloud = makeCloud(header, scan.echoes.size(), sizeof(Eigen::Vector4f));
  cloud->is_dense = std::all_of(scan.echoes.begin(), scan.echoes.end(), [](const auto& e) { return e.allFinite(); });
  for (const char* name : {"x", "y", "z", "intensity"}) {
    addField(*cloud, name, cloud->fields.size() * sizeof(float), sensor_msgs::PointField::FLOAT32);
  }
  for (std::size_t i = 0; i < scan.echoes.size(); ++i) {
    const Eigen::Vector4f row(scan.echoes[i].x(), scan.echoes[i].y(), scan.echoes[i].z(), scan.intensities[i]);
    std::memcpy(cloud->data.data() + i * sizeof(row), row.data(), sizeof(row));
  }
  return cloud;
}

SequenceBagSummary writeSequenceBag(const SequenceReader& sequence, const std::filesystem::path& file,
                                    const SequenceBagOptions& options, const std::function<void()>& progress) {
  checkTimes(sequence, options.odometry.rate);
  auto odometry = odometryOf(sequence, options.odometry);
  const double earliest = std::min(sequence.stamp(0), odometry.front().stamp);
  const SequenceBagSummary summary{sequence.size() * options.parts, odometry.size(), shiftFor(earliest)};
  for (OdometryPoint& point : odometry) point.stamp += summary.shift;

  ScanParts parts(options.parts);
  BagWriter writer(file, options.compression);
  const double start = earliest + summary.shift;
  writer.write("/tf_static", ros::Time(start) - kStep, toTransform(start, kBaseFrame, kSensorFrame, Pose()),
               latchedTransforms());
  auto next = odometry.begin();
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    SequenceScan scan = sequence.scan(i);
    scan.stamp += summary.shift;
    parts.cut(toScan(SequenceScan(scan)), durationOf(sequence, i));
    for (std::size_t k = 0; k < parts.count(); ++k) {
      const double sent = parts[k].stamp;
      for (; next != odometry.end() && next->stamp <= sent; ++next) writeOdometry(writer, *next);
      writer.write("/points", ros::Time(sent) + kStep + kStep, *toCloud(partOf(scan, parts.echoesOf(k))));
    }
    progress();
  }
  for (; next != odometry.end(); ++next) writeOdometry(writer, *next);
  writer.commit();
  return summary;
}

}  // namespace donex
