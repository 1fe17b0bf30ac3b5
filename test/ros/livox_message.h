// Livox' CustomMsg byte by byte, as its drivers send it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <ros/serialization.h>
#include <std_msgs/Header.h>
#include <topic_tools/shape_shifter.h>

#include "ros/livox_cloud.h"

namespace donex::test {

struct LivoxPoint {
  std::uint32_t offset_time;  ///< [ns]
  Eigen::Vector3f position;
  std::uint8_t reflectivity, tag, line;
};

/// Points at these places, 10 us apart.
inline std::vector<LivoxPoint> livoxPoints(const std::vector<Eigen::Vector3f>& echoes) {
  std::vector<LivoxPoint> points;
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    const auto byte = static_cast<std::uint8_t>(i);
    points.push_back({static_cast<std::uint32_t>(10000 * i), echoes[i], byte, static_cast<std::uint8_t>(byte % 7),
                      static_cast<std::uint8_t>(byte % 4)});
  }
  return points;
}

inline std::vector<std::uint8_t> livoxBytes(const std::vector<LivoxPoint>& points, const std_msgs::Header& header) {
  std::vector<std::uint8_t> bytes(1000 + 19 * points.size());
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  const auto count = static_cast<std::uint32_t>(points.size());
  stream.next(header);
  stream.next(header.stamp.toNSec());  // timebase
  stream.next(count);                  // point_num
  for (int i = 0; i < 4; ++i) stream.next(std::uint8_t{0});
  stream.next(count);
  for (const LivoxPoint& point : points) {
    stream.next(point.offset_time);
    for (int axis = 0; axis < 3; ++axis) stream.next(point.position[axis]);
    for (const std::uint8_t byte : {point.reflectivity, point.tag, point.line}) stream.next(byte);
  }
  bytes.resize(bytes.size() - stream.getLength());
  return bytes;
}

inline std::vector<std::uint8_t> livoxBytes(const std::vector<LivoxPoint>& points, double stamp,
                                            const std::string& frame = "lidar") {
  std_msgs::Header header;
  header.stamp.fromSec(stamp);
  header.frame_id = frame;
  return livoxBytes(points, header);
}

/// Fit to be published and to be written to a bag.
inline topic_tools::ShapeShifter messageOf(std::vector<std::uint8_t> bytes, const std::string& datatype,
                                           const std::string& md5 = kLivoxMd5) {
  topic_tools::ShapeShifter message;
  message.morph(md5, datatype, "# not of interest", "");
  ros::serialization::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  message.read(stream);
  return message;
}

}  // namespace donex::test
