// The upright box around an object's echoes.
#pragma once

#include <cstdint>
#include <memory_resource>
#include <vector>

#include "donex/object.h"

namespace donex {

/// Fits object.odom_from_box and object.size to the echoes `indices` of `points` (frame: odom_from_points,
/// [m]). The box's length lies along the velocity [m/s] of a moving object, else along the echoes' main axis.
void fitBox(const std::pmr::vector<std::uint32_t>& indices, const std::vector<Eigen::Vector3f>& points,
            const Eigen::Isometry3d& odom_from_points, const Eigen::Vector3d& velocity, Object& object);

}  // namespace donex
