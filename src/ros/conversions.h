// PointCloud2 -> the core's echoes, and labels -> PointCloud2. `layout` is always judgeLayout's of the same cloud.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <sensor_msgs/PointCloud2.h>

#include "donex/scan.h"
#include "ros/cloud_layout.h"

namespace donex {

/// The echoes in the order of the cloud, row by row, in the cloud's frame [m]. Overwrites `echoes`. A point at
/// exactly 0, 0, 0 is how drivers of organised clouds mark a beam without an echo: it becomes NaN.
void parseEchoes(const sensor_msgs::PointCloud2& cloud, const CloudLayout& layout,
                 std::vector<Eigen::Vector3f>& echoes);

/// Each echo's own time.
struct EchoTimes {
  std::vector<float> after_stamp;  ///< after the cloud's stamp [s], one per echo; negative before it
  double first = 0.0, last = 0.0;  ///< the span of the times of echoes with finite coordinates [s]
  std::size_t wild = 0;  ///< echoes whose times were none of the scan's, and were taken for the nearest that is
  std::string problem;  ///< why the cloud's times cannot be used; empty where they can, or where the cloud has no times

  bool empty() const { return after_stamp.empty(); }
  /// Keeps its memory.
  void clear();
};

/// A scan takes less than this; times further from the stamp belong to another clock [s].
constexpr double kMaxScanDuration = 1.0;

/// Absolute times beyond are nanoseconds, as Livox writes `timestamp`; the others' are seconds: no clock has seen so
/// many.
constexpr double kSecondsOfNoClock = 1e14;

/// Echoes and their times in one pass, into memory that is kept from scan to scan. No times where the cloud has none,
/// or where they cannot be times of this scan (another clock than the stamp's, not finite).
void parseEchoes(const sensor_msgs::PointCloud2& cloud, const CloudLayout& layout, std::vector<Eigen::Vector3f>& echoes,
                 EchoTimes& times);

/// The input with the fields `dynamic` and `observed`: same header, same order, every byte of every point kept.
sensor_msgs::PointCloud2Ptr labelCloud(const sensor_msgs::PointCloud2& cloud, const CloudLayout& layout,
                                       const EchoLabels& labels);

/// The cloud's times as they are written, in no unit yet, of at most `count` echoes with finite coordinates that are
/// spread evenly over it. Empty where it has none.
std::vector<double> sampleWrittenTimes(const sensor_msgs::PointCloud2& cloud, const CloudLayout& layout,
                                       std::size_t count);

/// The number of each echo's ring. The layout must have rings.
void parseRings(const sensor_msgs::PointCloud2& cloud, const CloudLayout& layout, std::vector<std::uint32_t>& rings);

enum class CloudPart { kDynamic, kStatic };

/// One of the two parts into which the labels divide the input, not organised; the input's own fields.
/// Non-finite echoes are in the static part.
sensor_msgs::PointCloud2Ptr selectPart(const sensor_msgs::PointCloud2& cloud, const CloudLayout& layout,
                                       const EchoLabels& labels, CloudPart part);

}  // namespace donex
