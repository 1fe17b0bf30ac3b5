// The truth that a simulated cloud carries.
#pragma once

#include <cstdint>
#include <vector>

#include <sensor_msgs/PointCloud2.h>

#include "donex/ros/cloud_layout.h"

namespace donex {

/// SemanticKITTI labels, one an echo: the cloud's field `label` (UINT32). Empty where it has none.
std::vector<std::uint32_t> truthOf(const sensor_msgs::PointCloud2& cloud, const CloudLayout& layout);

}  // namespace donex
