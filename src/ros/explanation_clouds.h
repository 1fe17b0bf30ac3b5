// Clouds to look at: every echo in the colour of its label and with the reason for it; remembered cells.
#pragma once

#include <vector>

#include <sensor_msgs/PointCloud2.h>

#include "ros/pipeline.h"

namespace donex {

/// The scan with the fields x, y, z, `reason` (UINT8, EchoReason) and `rgb` (as rviz and PCL have it): moving in
/// magenta, as in the paper; new without being an object in orange; ground and settled in a grey that grows lighter
/// with the height above the vehicle's frame; never seen free in dark blue; outside the grid nearly black.
sensor_msgs::PointCloud2Ptr explainScan(const LabeledScan& scan);

/// Centres of cells: x, y, z in `header`'s frame [m].
sensor_msgs::PointCloud2Ptr cellCloud(const std::vector<Eigen::Vector3f>& centers, const std_msgs::Header& header);

}  // namespace donex
