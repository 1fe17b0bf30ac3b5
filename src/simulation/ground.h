// The ground of a scene: roads with camber, kerbs, pavements, rough land, slopes.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "simulation/path.h"

namespace donex::simulation {

struct Road {
  Path middle;
  double half_width;  ///< [m]
};

/// Rises by `grade` over `length`, from `start` in the direction `yaw`; level before and after, rounded ends.
struct Slope {
  Eigen::Vector2d start;
  double yaw;     ///< [rad]
  double length;  ///< [m]
  double grade;   ///< rise over run
};

struct GroundStyle {
  double pavement_width = 2.5;  ///< beside every road [m]
  double kerb_height = 0.12;    ///< [m]
  double verge_drop = 0.0;      ///< how deep the land lies 6 m beyond the pavement [m]
  double waves = 0.06;          ///< height of the long waves [m]
  double roughness = 0.04;      ///< height of grass and clods beside the pavement [m]
  std::uint32_t land_label = 72;
};

struct GroundPoint {
  double height = 0.0;  ///< [m]
  std::uint32_t label = 0;
};

class Ground {
 public:
  explicit Ground(const GroundStyle& style = {}, std::uint64_t seed = 1);

  void add(const Road& road) { roads_.push_back(road); }
  void add(const Slope& slope) { slopes_.push_back(slope); }

  GroundPoint at(const Eigen::Vector2d& place) const;
  double height(const Eigen::Vector2d& place) const { return at(place).height; }
  /// From the nearest road's edge, negative on the road [m].
  double beyondEdge(const Eigen::Vector2d& place) const;

 private:
  struct Wave {
    Eigen::Vector2d number;  ///< [rad/m]
    double height;
    double phase;
  };
  double wide(const Eigen::Vector2d& place) const;
  double clods(const Eigen::Vector2d& place) const;

  GroundStyle style_;
  std::uint32_t seed_;
  std::vector<Wave> waves_;
  std::vector<Road> roads_;
  std::vector<Slope> slopes_;
};

}  // namespace donex::simulation
