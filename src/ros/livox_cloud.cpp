#include "ros/livox_cloud.h"

#include <array>
#include <cstring>
#include <limits>
#include <stdexcept>

#include <ros/serialization.h>
#include <std_msgs/Header.h>

#include "ros/cloud_fields.h"

namespace donex {
namespace {

using sensor_msgs::PointField;

/// Of a point as it is sent: offset_time, x, y, z, reflectivity, tag, line, without gaps [bytes].
constexpr std::uint32_t kSent = 19, kSentX = 4, kSentReflectivity = 16, kSentTag = 17;
/// Of a point of the cloud, aligned [bytes].
constexpr std::size_t kIntensity = 12, kTag = 16, kLine = 17, kOffsetTime = 20, kPointStep = 24;

void convert(const std::uint8_t* sent, std::uint8_t* point) {
  const auto intensity = static_cast<float>(sent[kSentReflectivity]);
  std::memcpy(point, sent + kSentX, kIntensity);
  std::memcpy(point + kIntensity, &intensity, sizeof intensity);
  std::memcpy(point + kTag, sent + kSentTag, kLine + 1 - kTag);
  std::memcpy(point + kOffsetTime, sent, kSentX);
}

}  // namespace

bool isLivox(const std::string& datatype, const std::string& md5) {
  return (datatype == "livox_ros_driver/CustomMsg" || datatype == "livox_ros_driver2/CustomMsg") && md5 == kLivoxMd5;
}

sensor_msgs::PointCloud2Ptr livoxCloud(const std::uint8_t* bytes, std::size_t size) {
  if (size > std::numeric_limits<std::uint32_t>::max()) throw std::invalid_argument("more than 4 GiB");
  // The stream has no reader of constant bytes, and writes none.
  ros::serialization::IStream stream(const_cast<std::uint8_t*>(bytes), static_cast<std::uint32_t>(size));
  std_msgs::Header header;
  std::uint64_t timebase = 0;
  std::uint32_t point_num = 0, points = 0;
  std::array<std::uint8_t, 4> lidar_id_and_reserved{};
  stream.next(header);
  stream.next(timebase);
  stream.next(point_num);
  for (std::uint8_t& byte : lidar_id_and_reserved) stream.next(byte);
  stream.next(points);
  if (points > stream.getLength() / kSent) ros::serialization::throwStreamOverrun();
  const std::uint8_t* sent = stream.advance(points * kSent);
  if (stream.getLength() != 0) throw std::invalid_argument(std::to_string(stream.getLength()) + " bytes too many");

  auto cloud = makeCloud(header, points, kPointStep);
  addField(*cloud, "x", 0, PointField::FLOAT32);
  addField(*cloud, "y", 4, PointField::FLOAT32);
  addField(*cloud, "z", 8, PointField::FLOAT32);
  addField(*cloud, "intensity", kIntensity, PointField::FLOAT32);
  addField(*cloud, "tag", kTag, PointField::UINT8);
  addField(*cloud, "line", kLine, PointField::UINT8);
  addField(*cloud, "offset_time", kOffsetTime, PointField::UINT32);
  for (std::size_t i = 0; i < points; ++i) convert(sent + kSent * i, cloud->data.data() + kPointStep * i);
  return cloud;
}

}  // namespace donex
