// What a spinning sensor sees in a room, ring by ring, without noise.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include "core/pi.h"

namespace donex::testing {

struct RingedCloud {
  std::vector<Eigen::Vector3f> echoes;
  std::vector<std::uint32_t> rings;
};

enum class Room { kWithWalls, kFloorAlone };

/// How far a beam reaches from 1.8 m above the floor, in a room of 16 x 8 m; infinite where it ends nowhere.
inline float rangeIn(Room room, const Eigen::Vector3f& direction) {
  float range = direction.z() < 0.0F ? -1.8F / direction.z() : std::numeric_limits<float>::infinity();
  if (room == Room::kFloorAlone) return range;
  range = std::min(range, (direction.x() > 0.0F ? 9.0F : -7.0F) / direction.x());
  return std::min(range, (direction.y() > 0.0F ? 3.0F : -5.0F) / direction.y());
}

/// Of 16 beams, 2 degrees apart, told in the frame that `frame_from_sensor` puts the sensor into.
inline RingedCloud ringsIn(Room room, const Eigen::Isometry3f& frame_from_sensor) {
  constexpr int kColumns = 400;
  constexpr auto kDegree = static_cast<float>(kPi / 180.0);
  RingedCloud cloud;
  for (std::uint32_t ring = 0; ring < 16; ++ring) {
    const float elevation = kDegree * (2.0F * static_cast<float>(ring) - 15.0F);
    for (int column = 0; column < kColumns; ++column) {
      const float azimuth = kDegree * 360.0F * static_cast<float>(column) / kColumns;
      const Eigen::Vector3f direction(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                      std::sin(elevation));
      const float range = rangeIn(room, direction);
      if (range > 100.0F) continue;
      cloud.echoes.push_back(frame_from_sensor * (range * direction));
      cloud.rings.push_back(ring);
    }
  }
  return cloud;
}

}  // namespace donex::testing
