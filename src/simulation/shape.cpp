#include "simulation/shape.h"

#include <algorithm>
#include <cmath>

#include "simulation/random.h"

namespace donex::simulation {
namespace {

struct Span {
  float enter;
  float leave;
};

/// Where the ray is between the two planes |coordinate| = half.
Span slab(float origin, float direction, float half) {
  if (direction == 0.0f) return std::abs(origin) <= half ? Span{-kMiss, kMiss} : Span{kMiss, -kMiss};
  const float inverse = 1.0f / direction;
  const float a = (-half - origin) * inverse;
  const float b = (half - origin) * inverse;
  return {std::min(a, b), std::max(a, b)};
}

Span both(Span a, Span b) { return {std::max(a.enter, b.enter), std::min(a.leave, b.leave)}; }

/// Roots of the quadratic form |p|^2 = 1 along origin + t direction.
template <class Vector>
Span unitBall(const Vector& origin, const Vector& direction) {
  const float a = direction.squaredNorm();
  const float b = origin.dot(direction);
  const float c = origin.squaredNorm() - 1.0f;
  if (a == 0.0f) return c <= 0.0f ? Span{-kMiss, kMiss} : Span{kMiss, -kMiss};
  const float discriminant = b * b - a * c;
  if (discriminant < 0.0f) return {kMiss, -kMiss};
  const float root = std::sqrt(discriminant);
  return {(-b - root) / a, (-b + root) / a};
}

Span boxSpan(const Ray& ray, const Eigen::Vector3f& half) {
  Span span = slab(ray.origin.x(), ray.direction.x(), half.x());
  span = both(span, slab(ray.origin.y(), ray.direction.y(), half.y()));
  return both(span, slab(ray.origin.z(), ray.direction.z(), half.z()));
}

Span cylinderSpan(const Ray& ray, const Eigen::Vector3f& half) {
  const Eigen::Vector2f origin = ray.origin.head<2>() / half.x();
  const Eigen::Vector2f direction = ray.direction.head<2>() / half.x();
  return both(unitBall(origin, direction), slab(ray.origin.z(), ray.direction.z(), half.z()));
}

Span ellipsoidSpan(const Ray& ray, const Eigen::Vector3f& half) {
  const Eigen::Vector3f inverse = half.cwiseInverse();
  const Eigen::Vector3f origin = ray.origin.cwiseProduct(inverse);
  const Eigen::Vector3f direction = ray.direction.cwiseProduct(inverse);
  return unitBall(origin, direction);
}

float entry(Span span, float limit) {
  const bool hit = span.enter <= span.leave && span.enter > 0.0f && span.enter < limit;
  if (!hit) return kMiss;
  return span.enter;
}

float enterSlats(const Shape& shape, const Ray& ray, float limit) {
  if (ray.direction.y() == 0.0f) return kMiss;
  const float t = -ray.origin.y() / ray.direction.y();
  if (!(t > 0.0f && t < limit)) return kMiss;
  const Eigen::Vector3f at = ray.origin + t * ray.direction;
  if (std::abs(at.x()) > shape.half.x() || std::abs(at.z()) > shape.half.z()) return kMiss;
  const float phase = at.x() / shape.pitch;
  if (!(phase - std::floor(phase) < shape.fill)) return kMiss;
  return t;
}

/// Walks the lattice cells on the ray between enter and leave, nearest first.
class LatticeWalk {
 public:
  LatticeWalk(const Ray& ray, float enter, float pitch) {
    for (int axis = 0; axis < 3; ++axis) {
      const float start = (ray.origin[axis] + enter * ray.direction[axis]) / pitch;
      cell_[axis] = static_cast<int>(std::floor(start));
      const float direction = ray.direction[axis];
      step_[axis] = direction < 0.0f ? -1 : 1;
      delta_[axis] = direction == 0.0f ? kMiss : pitch / std::abs(direction);
      const auto face = static_cast<float>(cell_[axis] + (direction < 0.0f ? 0 : 1));
      next_[axis] = direction == 0.0f ? kMiss : (face * pitch - ray.origin[axis]) / direction;
    }
  }

  const Eigen::Vector3i& cell() const { return cell_; }

  /// Goes on to the next cell; the parameter at which the ray enters it.
  float advance() {
    int axis = 0;
    const float entered = next_.minCoeff(&axis);
    cell_[axis] += step_[axis];
    next_[axis] += delta_[axis];
    return entered;
  }

 private:
  Eigen::Vector3i cell_;
  Eigen::Vector3i step_;
  Eigen::Vector3f delta_;
  Eigen::Vector3f next_;
};

float enterLeaves(const Shape& shape, const Ray& ray, float limit) {
  const Span crown = ellipsoidSpan(ray, shape.half);
  const float from = std::max(crown.enter, 0.0f);
  const float to = std::min(crown.leave, limit);
  if (!(from < to)) return kMiss;
  // A leaf lies wholly inside its cell: the first cell with a hit holds the nearest hit.
  LatticeWalk walk(ray, from, shape.pitch);
  for (float reached = from; reached < to; reached = walk.advance()) {
    const Leaf leaf = leafOf(shape, walk.cell());
    if (leaf.radius == 0.0f) continue;
    const Eigen::Vector3f origin = (ray.origin - leaf.center) / leaf.radius;
    const Eigen::Vector3f direction = ray.direction / leaf.radius;
    const Span span = unitBall(origin, direction);
    const bool inside_crown = span.enter > from && span.enter < to;
    if (span.enter <= span.leave && inside_crown) return span.enter;
  }
  return kMiss;
}

Eigen::Vector3f localNormal(const Shape& shape, const Eigen::Vector3f& p, const Eigen::Vector3f& direction) {
  const Eigen::Vector3f relative = p.cwiseQuotient(shape.half);
  switch (shape.kind) {
    case ShapeKind::kBox: {
      int axis = 0;
      relative.cwiseAbs().maxCoeff(&axis);
      return std::copysign(1.0f, relative[axis]) * Eigen::Vector3f::Unit(axis);
    }
    case ShapeKind::kCylinder: {
      const bool on_end = std::abs(relative.z()) > relative.head<2>().norm();
      if (on_end) return std::copysign(1.0f, relative.z()) * Eigen::Vector3f::UnitZ();
      return Eigen::Vector3f(p.x(), p.y(), 0.0f).normalized();
    }
    case ShapeKind::kEllipsoid: return relative.cwiseQuotient(shape.half).normalized();
    case ShapeKind::kLeaves: return -direction.normalized();
    case ShapeKind::kSlats: return -std::copysign(1.0f, direction.y()) * Eigen::Vector3f::UnitY();
  }
  return Eigen::Vector3f::UnitZ();
}

}  // namespace

Leaf leafOf(const Shape& shape, const Eigen::Vector3i& cell) {
  const std::uint64_t bits = cellHash(cell.x(), cell.y(), cell.z(), shape.seed);
  const auto part = [bits](int i) { return static_cast<float>(bits >> (12 * i) & 0xFFF) / 4096.0f; };
  if (part(0) >= shape.fill) return {};
  Leaf leaf;
  leaf.radius = shape.pitch * (0.22f + 0.16f * part(1));
  const Eigen::Vector3f place(part(2), part(3), part(4));
  const Eigen::Vector3f room = Eigen::Vector3f::Constant(shape.pitch - 2.0f * leaf.radius);
  leaf.center = cell.cast<float>() * shape.pitch + Eigen::Vector3f::Constant(leaf.radius) + room.cwiseProduct(place);
  return leaf;
}

float intersect(const Shape& shape, const Ray& world_ray, float limit) {
  const Ray ray = shape.toLocal(world_ray);
  switch (shape.kind) {
    case ShapeKind::kBox: return entry(boxSpan(ray, shape.half), limit);
    case ShapeKind::kCylinder: return entry(cylinderSpan(ray, shape.half), limit);
    case ShapeKind::kEllipsoid: return entry(ellipsoidSpan(ray, shape.half), limit);
    case ShapeKind::kLeaves: return enterLeaves(shape, ray, limit);
    case ShapeKind::kSlats: return enterSlats(shape, ray, limit);
  }
  return kMiss;
}

Eigen::Vector3f normalAt(const Shape& shape, const Eigen::Vector3f& point, const Eigen::Vector3f& direction) {
  const Eigen::Vector3f local = shape.axes.transpose() * (point - shape.center);
  return shape.axes * localNormal(shape, local, shape.axes.transpose() * direction);
}

}  // namespace donex::simulation
