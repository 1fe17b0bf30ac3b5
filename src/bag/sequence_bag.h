// A sequence on disk -> a bag as a vehicle records it: clouds, odometry, tf.
#pragma once

#include <filesystem>
#include <functional>

#include <rosbag/bag.h>
#include <sensor_msgs/PointCloud2.h>

#include "io/odometry_path.h"
#include "io/sequence.h"

namespace donex {

struct SequenceBagOptions {
  OdometryRhythm odometry;  ///< by default the scans' own: then the node gives the labels donex_sequence gives
  rosbag::CompressionType compression = rosbag::compression::Uncompressed;
  std::size_t parts = 1;  ///< clouds per scan, sectors of equal azimuth: of the scan's stamp, sent as the sensor turns
};

/// x, y, z, intensity as float32, unorganised, frame "velodyne".
sensor_msgs::PointCloud2Ptr toCloud(const SequenceScan& scan);

/// What went into the bag.
struct SequenceBagSummary {
  std::size_t clouds = 0, odometry = 0;
  double shift = 0.0;  ///< added to all stamps [s]: a bag knows no time before 0 and tf none at 0
};

/// Topics /points (frame velodyne), /odom (odom, base_link), /tf (the same motion), /tf_static (velodyne is
/// base_link). `progress` is called after each scan. Throws DataError, and
/// std::invalid_argument where ScanParts does.
SequenceBagSummary writeSequenceBag(const SequenceReader& sequence, const std::filesystem::path& file,
                                    const SequenceBagOptions& options, const std::function<void()>& progress);

}  // namespace donex
