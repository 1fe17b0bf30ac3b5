// What is strange about a cloud that is labelled all the same.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "donex/config.h"
#include "donex/scan.h"
#include "ros/no_returns.h"

namespace donex {

enum class CloudRemark {
  kNoReturns,     ///< positions were written for beams without an echo
  kRegionMissed,  ///< hardly an echo lies in the region
  kWildTimes,     ///< single echoes' times lie outside of the scan
  kNoGround,      ///< somebody has removed it, or the sensor does not see it
};
constexpr std::size_t kCloudRemarks = 4;

/// In words, fit for a key of the diagnostics.
const char* describe(CloudRemark remark);

/// Of the newest cloud, by kind; empty where nothing is strange.
using CloudRemarks = std::array<std::string, kCloudRemarks>;

inline const std::string& remarkOf(const CloudRemarks& remarks, CloudRemark kind) {
  return remarks[static_cast<std::size_t>(kind)];
}

/// `no_returns` as they were found before the scan was de-skewed.
CloudRemarks remarksOn(const Scan& scan, const NoReturns& no_returns, const Region& region, std::size_t wild_times,
                       bool lacks_ground);

}  // namespace donex
