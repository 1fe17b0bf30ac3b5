// Which echoes count at all.
#pragma once

namespace donex {

/// Echoes beyond this distance from the sensor [m] are invalid, like non-finite ones.
constexpr float kFarthestEcho = 1000.0F;

}  // namespace donex
