// The clouds of a bag, of whichever type that is read.
#pragma once

#include <string>
#include <vector>

#include <rosbag/message_instance.h>
#include <sensor_msgs/PointCloud2.h>

namespace donex {

/// sensor_msgs/PointCloud2 and Livox' CustomMsg.
std::vector<std::string> cloudTypes();

/// Throws DataError where the bytes are none, or the type is not as its driver defines it.
sensor_msgs::PointCloud2ConstPtr parseCloud(const rosbag::MessageInstance& message);

}  // namespace donex
