// Azimuths, quickly.
#pragma once

#include <cmath>

#include "core/pi.h"

namespace donex {

/// atan2 to 1e-4 rad, the same on every machine; monotone within an octant. Nothing in it is a branch,
/// so that loops over it are wide.
inline float azimuthOf(float y, float x) {
  const float ax = std::abs(x), ay = std::abs(y);
  const auto is_beside = static_cast<float>(ay > ax), is_ahead = 1.0F - is_beside;
  const float a = (is_beside * ax + is_ahead * ay) / (is_beside * ay + is_ahead * ax);  // the smaller by the larger one
  const float s = a * a;
  const float in_octant = ((-0.0464964749F * s + 0.15931422F) * s - 0.327622764F) * s * a + a;
  const float in_quadrant = is_beside * (0.5F * kPiF) + (is_ahead - is_beside) * in_octant;
  const auto is_behind = static_cast<float>(x < 0.0F);
  const float angle = is_behind * kPiF + (1.0F - 2.0F * is_behind) * in_quadrant;
  return y < 0.0F ? -angle : angle;
}

}  // namespace donex
