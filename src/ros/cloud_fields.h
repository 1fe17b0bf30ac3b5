// Making clouds: their header and their fields.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <sensor_msgs/PointCloud2.h>

namespace donex {

/// A cloud of `points` points of `point_step` bytes, not organised, in this machine's byte order; it has no fields
/// yet, and every byte is zero.
sensor_msgs::PointCloud2Ptr makeCloud(const std_msgs::Header& header, std::size_t points, std::size_t point_step);

/// Appends a field of one number, at `offset` bytes from the point's start. The points themselves stay.
void addField(sensor_msgs::PointCloud2& cloud, const std::string& name, std::size_t offset, std::uint8_t datatype);

}  // namespace donex
