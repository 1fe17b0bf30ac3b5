// Small bags for the tests.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <boost/make_shared.hpp>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <std_msgs/String.h>

#include "bag/label_bag.h"
#include "bag/sequence_bag.h"
#include "support/sequences.h"
#include "support/temporary_directory.h"

namespace donex::test {

/// A message as its bytes and everything the bag says of it.
struct RawMessage {
  std::string topic;
  ros::Time time;
  std::string bytes;
  ros::M_string header;  ///< of the connection

  bool operator==(const RawMessage& other) const {
    return topic == other.topic && time == other.time && bytes == other.bytes && header == other.header;
  }
};

inline std::vector<RawMessage> readAll(const std::filesystem::path& file, const std::string& except = "") {
  rosbag::Bag bag(file.string());
  rosbag::View view(bag);
  std::vector<RawMessage> messages;
  for (const rosbag::MessageInstance& message : view) {
    if (message.getTopic() == except) continue;
    std::string bytes(message.size(), '\0');
    ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()), message.size());
    message.write(stream);
    messages.push_back({message.getTopic(), message.getTime(), bytes, *message.getConnectionHeader()});
  }
  return messages;
}

template <class Message>
std::vector<typename Message::ConstPtr> readTopic(const std::filesystem::path& file, const std::string& topic) {
  rosbag::Bag bag(file.string());
  rosbag::View view(bag, rosbag::TopicQuery(topic));
  std::vector<typename Message::ConstPtr> messages;
  for (const rosbag::MessageInstance& message : view) messages.push_back(message.instantiate<Message>());
  return messages;
}

/// A drive of `scans` small random scans as a sequence in `directory`.
inline void writeDrive(const std::filesystem::path& directory, std::size_t scans) {
  std::mt19937 random(21);
  SequenceWriter writer(directory);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (std::size_t i = 0; i < scans; ++i) {
    SequenceScan scan = randomScan(random, i, 400);
    scan.stamp += 50.0;
    scan.odom_from_sensor = Pose::fromIsometry(pose);
    writer.add(scan);
    pose = pose * integrateTwist({{5.0, 0.1, 0.0}, {0.0, 0.01, 0.3}}, 0.1);
  }
}

/// The same as a bag.
inline void writeDriveBag(const std::filesystem::path& directory, const std::filesystem::path& file, std::size_t scans,
                          const SequenceBagOptions& options = {}) {
  writeDrive(directory, scans);
  writeSequenceBag(SequenceReader(directory), file, options, [] {});
}

/// Adds messages to a bag that is there.
inline void change(const std::filesystem::path& file, const std::function<void(rosbag::Bag&)>& add) {
  rosbag::Bag bag(file.string(), rosbag::bagmode::Append);
  add(bag);
}

inline std_msgs::String text(const std::string& data) {
  std_msgs::String message;
  message.data = data;
  return message;
}

inline LabelBagSummary label(const std::filesystem::path& in, const std::filesystem::path& out,
                             const LabelBagOptions& options = {}) {
  return labelBag({in}, {out}, options, [](std::size_t, std::size_t) {});
}

/// Where labelBag writes by default.
inline constexpr const char* kLabeled = "/donex/labeled_points";

/// The bytes of the field `dynamic`.
inline std::vector<std::uint8_t> dynamicOf(const sensor_msgs::PointCloud2& cloud) {
  std::vector<std::uint8_t> labels;
  for (const auto& field : cloud.fields) {
    if (field.name != "dynamic") continue;
    for (std::size_t i = 0; i < cloud.width; ++i) labels.push_back(cloud.data[i * cloud.point_step + field.offset]);
  }
  return labels;
}

using ScanLabels = std::vector<std::vector<std::uint8_t>>;  // one per echo, scan by scan

inline long countDynamic(const ScanLabels& labels) {
  long count = 0;
  for (const auto& scan : labels) count += std::count(scan.begin(), scan.end(), 1);
  return count;
}

}  // namespace donex::test
