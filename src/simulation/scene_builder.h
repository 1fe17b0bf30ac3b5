// Furnishes a scene: everything stands on its ground.
#pragma once

#include <memory>

#include "simulation/random.h"
#include "simulation/scene.h"
#include "simulation/track.h"

namespace donex::simulation {

using SharedPath = std::shared_ptr<const Path>;

class SceneBuilder {
 public:
  SceneBuilder(const GroundStyle& style, std::uint64_t seed) : random_(seed) { scene_.ground = Ground(style, seed); }

  Scene& scene() { return scene_; }
  Ground& ground() { return scene_.ground; }
  Random& random() { return random_; }

  /// A box on the ground; `size` along, across, up.
  void block(const PathPoint& place, const Eigen::Vector3d& size, std::uint32_t label, float reflectivity,
             double above_ground = 0.0);
  /// A building whose front, `width` wide, looks to the left of `front`; it stands to its right.
  void house(const PathPoint& front, double width, double depth, double height);
  void tree(const Eigen::Vector2d& place, float sway = 0.0f);
  void bush(const Eigen::Vector2d& place, double width, double height, float sway = 0.0f);
  void pole(const Eigen::Vector2d& place, double height, double radius, std::uint32_t label = 80);
  void sign(const PathPoint& place);
  /// Something of a kind that moves, standing: a parked car, somebody who waits.
  void parked(const PathPoint& place, const Model& model);
  /// Upright slats between two places.
  void slats(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double height);
  void wall(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double height, std::uint32_t label = 50);

  // Along [from, to] of a path, `lateral` to its left.
  void guardRail(const Path& path, double from, double to, double lateral);
  void hedge(const Path& path, double from, double to, double lateral, double height, float sway = 0.0f);
  void picketFence(const Path& path, double from, double to, double lateral, double height);

  /// The sensor on the vehicle's roof, with the small tilt of a real mounting.
  void ego(const Course& course);
  /// A deck over the whole road, `width` wide, on pillars beside it.
  void bridge(const Path& path, double s, double half_span, double clearance, double width);
  void add(const Model& model, const Course& course);
  /// Tries places along the path for the start until the mover meets neither the ego vehicle nor another mover
  /// within `horizon` [s]; false, and nothing added, when there is none.
  bool addClear(const Model& model, Course course, double horizon = 40.0);

 private:
  void place(const Eigen::Vector2d& at, double above_ground, const Shape& shape, std::uint32_t label,
             float reflectivity, float sway = 0.0f);
  void leaves(const Eigen::Vector2d& at, double above_ground, const Eigen::Vector3f& half, float pitch, float fill,
              float sway);

  Scene scene_{Ground(), {}, {}, {}, 64};
  Random random_;
  std::vector<Track> tracks_;  // of the movers
  Track ego_track_;
};

/// A circuit of two straights and two half circles, to the left.
SharedPath oval(double straight, double radius, double yaw);
/// A person's or cyclist's loop across a road: over, back beside, for ever.
SharedPath crossing(const PathPoint& middle_of_road, double half_length);
/// `mean` with a slow swing, the same for everyone with the same phase: gaps in a lane stay open.
SpeedProfile swinging(double mean, double swing, double period, double phase);

}  // namespace donex::simulation
