// What C++17 has no name for.
#pragma once

namespace donex {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr float kPiF = 3.14159265F;
inline constexpr double kRadiansPerDegree = kPi / 180.0;

}  // namespace donex
