#include "core/sector.h"

#include <algorithm>
#include <cmath>

#include "core/pi.h"

namespace donex {

std::size_t sectorOf(const Eigen::Vector3f& echo, std::size_t sectors) {
  const float azimuth = std::atan2(echo.y(), echo.x());
  if (!std::isfinite(azimuth)) return 0;
  const float turn = azimuth / (2.0F * kPiF);
  const float share = turn < 0.0F ? turn + 1.0F : turn;
  return std::min(static_cast<std::size_t>(share * static_cast<float>(sectors)), sectors - 1);
}

}  // namespace donex
