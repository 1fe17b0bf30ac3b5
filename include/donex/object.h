// A moving object: connected echoes followed over time (algorithm: "Objects").
#pragma once

#include <cstdint>

#include <Eigen/Geometry>

#include "donex/proof.h"

namespace donex {

struct Object {
  std::uint32_t id = 0;  ///< stable while the object is followed; never reused before a reset
  /// Centre of the oriented box, axes x along the length, z up; odometry frame [m].
  Eigen::Isometry3d odom_from_box = Eigen::Isometry3d::Identity();
  Eigen::Vector3d size = Eigen::Vector3d::Zero();      ///< length, width, height [m]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< odometry frame [m/s]
  bool dynamic = false;
  Proof proof = Proof::kNone;  ///< of its motion in the present scan
  double age = 0.0;            ///< time since first seen [s]
  std::uint32_t echoes = 0;    ///< echoes of the present turn, as far as it has come, that belong to it
};

}  // namespace donex
