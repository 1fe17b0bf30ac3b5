// The middle of a road or the way of a walker: straight pieces and arcs, in the plane.
#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Core>

namespace donex::simulation {

struct PathPoint {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< [m]
  double yaw = 0.0;                                    ///< direction of travel [rad]
  double curvature = 0.0;                              ///< to the left [1/m]

  Eigen::Vector2d forward() const { return {std::cos(yaw), std::sin(yaw)}; }
  Eigen::Vector2d left() const { return {-std::sin(yaw), std::cos(yaw)}; }
};

class Path {
 public:
  Path(const Eigen::Vector2d& start, double yaw) : end_{start, yaw, 0.0} {}

  Path& line(double length);
  /// Turns by `angle` [rad], left where positive; `radius` [m] is positive.
  Path& arc(double radius, double angle);
  /// From now on a place beyond the end is one as far beyond the start: a circuit, or a road whose traffic returns.
  Path& wrap();

  double length() const { return length_; }
  bool wraps() const { return wraps_; }

  /// The place `s` [m] along, moved `lateral` [m] to the left. Beyond the ends straight on, unless it wraps.
  PathPoint at(double s, double lateral = 0.0) const;

  struct Projection {
    double s = 0.0;
    double lateral = 0.0;   ///< to the left [m]
    double distance = 0.0;  ///< differs from |lateral| beyond the ends [m]
  };
  Projection project(const Eigen::Vector2d& point) const;

 private:
  struct Piece {
    double s;  ///< where it begins
    double length;
    PathPoint start;
    Eigen::Vector2d forward;  ///< at the start
    Eigen::Vector2d left;
    Eigen::Vector2d middle;  ///< no place on it is further from here than half its length
  };
  static PathPoint along(const Piece& piece, double s);
  static Projection projectOnto(const Piece& piece, const Eigen::Vector2d& point);
  void append(double length, double curvature);

  std::vector<Piece> pieces_;
  PathPoint end_;
  double length_ = 0.0;
  bool wraps_ = false;
};

}  // namespace donex::simulation
