#include "ros/cloud_remarks.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/timing.h"

namespace donex {
namespace {

constexpr std::size_t kSample = 4096;    // echoes of a scan that are looked at
constexpr std::size_t kFew = 100;        // with fewer echoes nothing is said
constexpr double kHardlyAny = 0.01;      // of the echoes, in the region
constexpr double kFartherThanAny = 300;  // median range that no LiDAR's scans have [m]

/// Calls visit(echo in the sensor's frame [m]) for echoes spread evenly over the scan.
template <class Visit>
void forSample(const Scan& scan, Visit&& visit) {
  const std::size_t step = std::max<std::size_t>(1, scan.echoes.size() / kSample);
  for (std::size_t i = 0; i < scan.echoes.size(); i += step) {
    if (scan.echoes[i].allFinite()) visit(scan.echoes[i].cast<double>());
  }
}

/// The region against where the echoes are.
std::string describe(const Scan& scan, const Region& region, double share) {
  std::vector<double> ranges, heights;  // from the sensor, in the vehicle's frame [m]
  forSample(scan, [&](const Eigen::Vector3d& echo) {
    ranges.push_back(echo.norm());
    heights.push_back((scan.base_from_sensor * echo).z());
  });
  const double middle = quantile(ranges, 0.5);
  const std::string text = fmt::format(
      "{:.1f} % of the echoes lie in the region, {:.0f} m by {:.0f} m and from z {:.1f} to {:.1f} m of the vehicle's "
      "frame; of ten echoes eight lie between z {:.1f} and {:.1f} m, half of them farther than {:.1f} m",
      100.0 * share, region.x_max - region.x_min, region.y_max - region.y_min, region.z_min, region.z_max,
      quantile(heights, 0.1), quantile(heights, 0.9), middle);
  return text + (middle > kFartherThanAny ? ": are the clouds in metres?" : "");
}

std::string regionMissed(const Scan& scan, const Region& region) {
  const Eigen::Array3d low(region.x_min, region.y_min, region.z_min), high(region.x_max, region.y_max, region.z_max);
  std::size_t measured = 0, inside = 0;
  forSample(scan, [&](const Eigen::Vector3d& echo) {
    const Eigen::Array3d place = (scan.base_from_sensor * echo).array();
    ++measured;
    inside += (place >= low).all() && (place <= high).all() ? 1U : 0U;
  });
  const double share = static_cast<double>(inside) / static_cast<double>(std::max<std::size_t>(measured, 1));
  return measured < kFew || share >= kHardlyAny ? "" : describe(scan, region, share);
}

std::string noReturns(const NoReturns& found) {
  if (found.at_largest_range == 0) return {};
  return fmt::format("{} echoes at one largest range, {:.3f} m, are taken for beams without an echo",
                     found.at_largest_range, found.largest_range);
}

}  // namespace

const char* describe(CloudRemark remark) {
  switch (remark) {
    case CloudRemark::kNoReturns: return "beams without an echo";
    case CloudRemark::kRegionMissed: return "hardly an echo in the region";
    case CloudRemark::kWildTimes: return "echo times outside of the scan";
    case CloudRemark::kNoGround: return "no ground found";
  }
  return "unknown";
}

CloudRemarks remarksOn(const Scan& scan, const NoReturns& no_returns, const Region& region, std::size_t wild_times,
                       bool lacks_ground) {
  const std::string wild = wild_times == 0 ? "" : fmt::format("{}, taken for the scan's nearest end", wild_times);
  const char* ground =
      lacks_ground ? "hardly an echo lies on it: it was removed beforehand, or the sensor does not see it" : "";
  return {noReturns(no_returns), regionMissed(scan, region), wild, ground};
}

}  // namespace donex
