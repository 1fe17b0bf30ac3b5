// The clouds of Livox' drivers in their own message type, read by its definition: no package of theirs is needed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <sensor_msgs/PointCloud2.h>

namespace donex {

/// Of livox_ros_driver/CustomMsg and livox_ros_driver2/CustomMsg, whose fields are the same.
constexpr const char* kLivoxMd5 = "e4d6829bdfe657cb6c21a746c86b21a6";

/// Whether it is one of the two, as their drivers define it.
bool isLivox(const std::string& datatype, const std::string& md5);

/// A CustomMsg as it is sent -> x, y, z, intensity (FLOAT32), tag, line (UINT8), offset_time (UINT32 [ns], taken to
/// count from the stamp, as the drivers send it). The number of points is that of the points that are there. Throws
/// ros::serialization::StreamOverrunException where the bytes end too early, std::invalid_argument where bytes are
/// left.
sensor_msgs::PointCloud2Ptr livoxCloud(const std::uint8_t* bytes, std::size_t size);

}  // namespace donex
