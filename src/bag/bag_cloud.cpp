#include "bag/bag_cloud.h"

#include <fmt/format.h>
#include <ros/serialization.h>

#include "bag/checked_message.h"
#include "ros/livox_cloud.h"

namespace donex {
namespace {

const std::string kPlain = "sensor_msgs/PointCloud2";

}  // namespace

std::vector<std::string> cloudTypes() { return {kPlain, "livox_ros_driver/CustomMsg", "livox_ros_driver2/CustomMsg"}; }

sensor_msgs::PointCloud2ConstPtr parseCloud(const rosbag::MessageInstance& message) {
  if (message.getDataType() == kPlain) return parse<sensor_msgs::PointCloud2>(message);
  const std::string where = fmt::format("{} at {:.9f} s", message.getTopic(), message.getTime().toSec());
  const std::string md5 = message.getMD5Sum();
  if (!isLivox(message.getDataType(), md5)) {
    throw DataError(fmt::format("{}: is a {} of another definition (md5 {}, read is {})", where, message.getDataType(),
                                md5, kLivoxMd5));
  }
  std::vector<std::uint8_t> bytes(message.size());
  ros::serialization::OStream stream(bytes.data(), message.size());
  message.write(stream);
  try {
    return livoxCloud(bytes.data(), bytes.size());
  } catch (const std::exception& error) {
    throw DataError(fmt::format("{}: cannot be read ({})", where, error.what()));
  }
}

}  // namespace donex
