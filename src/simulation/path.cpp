#include "simulation/path.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/pi.h"

namespace donex::simulation {
namespace {

double wrapAngle(double angle) { return angle - 2.0 * kPi * std::round(angle / (2.0 * kPi)); }

}  // namespace

Path& Path::line(double length) {
  append(length, 0.0);
  return *this;
}

Path& Path::arc(double radius, double angle) {
  append(radius * std::abs(angle), (angle < 0.0 ? -1.0 : 1.0) / radius);
  return *this;
}

Path& Path::wrap() {
  wraps_ = true;
  return *this;
}

void Path::append(double length, double curvature) {
  PathPoint start = end_;
  start.curvature = curvature;
  pieces_.push_back({length_, length, start, start.forward(), start.left(), start.position});
  pieces_.back().middle = along(pieces_.back(), 0.5 * length).position;
  end_ = along(pieces_.back(), length);
  length_ += length;
}

PathPoint Path::along(const Piece& piece, double s) {
  PathPoint point = piece.start;
  const double k = piece.start.curvature;
  if (k == 0.0) {
    point.position += s * piece.forward;
    return point;
  }
  point.yaw = piece.start.yaw + k * s;
  point.position += (piece.left - point.left()) / k;
  return point;
}

PathPoint Path::at(double s, double lateral) const {
  if (wraps_) s -= length_ * std::floor(s / length_);
  const auto after = std::upper_bound(pieces_.begin(), pieces_.end(), s,
                                      [](double value, const Piece& piece) { return value < piece.s; });
  const Piece& piece = after == pieces_.begin() ? pieces_.front() : *std::prev(after);
  const double inside = std::clamp(s - piece.s, 0.0, piece.length);
  PathPoint point = along(piece, inside);
  point.position += (s - piece.s - inside) * point.forward() + lateral * point.left();
  return point;
}

Path::Projection Path::projectOnto(const Piece& piece, const Eigen::Vector2d& point) {
  const double k = piece.start.curvature;
  const Eigen::Vector2d from_start = point - piece.start.position;
  double s = from_start.dot(piece.forward);
  double lateral = from_start.dot(piece.left);
  if (k != 0.0) {
    const Eigen::Vector2d from_center = from_start - piece.left / k;
    const Eigen::Vector2d outward = -std::copysign(1.0, k) * piece.left;
    const double turned =
        std::atan2(outward.x() * from_center.y() - outward.y() * from_center.x(), outward.dot(from_center));
    // Seen from the arc's middle, so that the cut lies opposite to it.
    const double half_turn = 0.5 * piece.length * k;
    s = (wrapAngle(turned - half_turn) + half_turn) / k;
    lateral = std::copysign(1.0, k) * (1.0 / std::abs(k) - from_center.norm());
  }
  if (s >= 0.0 && s <= piece.length) return {piece.s + s, lateral, std::abs(lateral)};
  s = std::clamp(s, 0.0, piece.length);
  const PathPoint end = along(piece, s);
  const Eigen::Vector2d offset = point - end.position;
  return {piece.s + s, offset.dot(end.left()), offset.norm()};
}

Path::Projection Path::project(const Eigen::Vector2d& point) const {
  Projection best;
  best.distance = std::numeric_limits<double>::infinity();
  for (const Piece& piece : pieces_) {
    const double at_least = (point - piece.middle).norm() - 0.5 * piece.length;
    if (at_least >= best.distance) continue;
    const Projection candidate = projectOnto(piece, point);
    if (candidate.distance < best.distance) best = candidate;
  }
  return best;
}

}  // namespace donex::simulation
