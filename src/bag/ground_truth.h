// The truth that a simulated cloud carries.
#pragma once

#include <cstdint>
#include <vector>

#include <sensor_msgs/PointCloud2.h>

#include "ros/cloud_layout.h"

namespace donex {

/// SemanticKITTI labels, one per echo in the cloud's order: its field `label` (UINT32). Empty where the cloud has no
/// such field. `layout` is what judgeLayout said of this cloud.
std::vector<std::uint32_t> truthOf(const sensor_msgs::PointCloud2& cloud, const CloudLayout& layout);

}  // namespace donex
