// The solids a ray can meet, each in axes of its own.
#pragma once

#include <cstdint>
#include <limits>

#include <Eigen/Geometry>

namespace donex::simulation {

enum class ShapeKind : std::uint8_t {
  kBox,        ///< |x| <= half.x, |y| <= half.y, |z| <= half.z
  kCylinder,   ///< around z, radius half.x (= half.y), |z| <= half.z
  kEllipsoid,  ///< half axes `half`
  kLeaves,     ///< small spheres at random places of a lattice, inside the ellipsoid
  kSlats,      ///< upright slats in the plane y = 0, |x| <= half.x, |z| <= half.z
};

/// A half line from `origin`; `direction` need not have unit length, the ray's parameter counts in it.
struct Ray {
  Eigen::Vector3f origin;
  Eigen::Vector3f direction;
};

inline constexpr float kMiss = std::numeric_limits<float>::infinity();

struct Shape {
  ShapeKind kind = ShapeKind::kBox;
  Eigen::Vector3f center = Eigen::Vector3f::Zero();    ///< [m]
  Eigen::Matrix3f axes = Eigen::Matrix3f::Identity();  ///< columns: the shape's axes in the frame of `center`
  Eigen::Vector3f half = Eigen::Vector3f::Ones();      ///< [m]
  float pitch = 0.2f;      ///< leaves: edge of a lattice cell, one leaf at most in each; slats: distance [m]
  float fill = 0.5f;       ///< leaves: fraction of the cells with a leaf; slats: fraction that is wood
  std::uint32_t seed = 0;  ///< leaves

  Ray toLocal(const Ray& ray) const {
    return {axes.transpose() * (ray.origin - center), axes.transpose() * ray.direction};
  }
};

/// A leaf of the lattice cell, in the shape's own axes; radius 0: none.
struct Leaf {
  Eigen::Vector3f center;
  float radius = 0.0f;
};
Leaf leafOf(const Shape& shape, const Eigen::Vector3i& cell);

/// Where the ray enters the shape: the smallest parameter in (0, limit) that lies on its outside seen from the
/// origin; kMiss without one. A ray that begins inside a solid misses it.
float intersect(const Shape& shape, const Ray& ray, float limit = kMiss);

/// Outward unit normal at a point of the surface; for leaves and slats against the ray.
Eigen::Vector3f normalAt(const Shape& shape, const Eigen::Vector3f& point, const Eigen::Vector3f& direction);

}  // namespace donex::simulation
