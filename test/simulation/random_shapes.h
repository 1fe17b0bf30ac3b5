// Random solids and rays for tests.
#pragma once

#include "simulation/random.h"
#include "simulation/shape.h"

namespace donex::simulation {

inline Eigen::Vector3f randomVector(Random& random, double reach) {
  const auto x = static_cast<float>(random.uniform(-reach, reach));
  const auto y = static_cast<float>(random.uniform(-reach, reach));
  const auto z = static_cast<float>(random.uniform(-reach, reach));
  return {x, y, z};
}

inline Shape randomShape(Random& random, ShapeKind kind, double reach) {
  Shape shape;
  shape.kind = kind;
  shape.center = randomVector(random, reach);
  const Eigen::Vector3f axis = randomVector(random, 1.0).normalized();
  shape.axes = Eigen::AngleAxisf(static_cast<float>(random.uniform(0.0, 3.0)), axis).toRotationMatrix();
  shape.half = (randomVector(random, 1.2).cwiseAbs().array() + 0.05f).matrix();
  if (kind == ShapeKind::kCylinder) shape.half.y() = shape.half.x();
  shape.pitch = static_cast<float>(random.uniform(0.15, 0.3));
  shape.fill = static_cast<float>(random.uniform(0.2, 0.7));
  shape.seed = static_cast<std::uint32_t>(random.bits());
  return shape;
}

inline constexpr ShapeKind kAllKinds[] = {ShapeKind::kBox, ShapeKind::kCylinder, ShapeKind::kEllipsoid,
                                          ShapeKind::kLeaves, ShapeKind::kSlats};

}  // namespace donex::simulation
