// Sectors around a sensor.
#pragma once

#include <cstddef>

#include <Eigen/Core>

namespace donex {

/// More clouds than any driver makes of a turn.
inline constexpr std::size_t kMostSectors = 1000;

/// Which of so many sectors of equal azimuth, counter-clockwise from straight ahead; an echo without a direction is in
/// the first one.
std::size_t sectorOf(const Eigen::Vector3f& echo, std::size_t sectors);

}  // namespace donex
