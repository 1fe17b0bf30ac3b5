// A scan as the steps of evidence see it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

namespace donex {

/// What the grid knows of the place an echo hit.
enum class Place : std::uint8_t {
  kUnobserved,   ///< hit for the first time not long ago, and never seen free before; or not asked
  kNew,          ///< occupied not long ago after it had been seen free: something came
  kSurelyNew,    ///< the same, and most scans that knew anything of it had seen it free
  kCoarselyNew,  ///< as kNew, but beams so far apart had seen it free that something low may have stood between them
  kSurelyCoarselyNew,  ///< both of these
  kAtSurface,  ///< a surface's flicker: it touched a settled one when it became occupied, or earlier scans saw one here
  kSettled,    ///< occupied for longer than the birth window
};

inline bool isNewPlace(Place place) { return place >= Place::kNew && place <= Place::kSurelyCoarselyNew; }
inline bool isSurelyNew(Place place) { return place == Place::kSurelyNew || place == Place::kSurelyCoarselyNew; }
inline bool isCoarselyNew(Place place) { return place == Place::kCoarselyNew || place == Place::kSurelyCoarselyNew; }
inline Place newPlace(bool surely, bool coarsely) {
  if (coarsely) return surely ? Place::kSurelyCoarselyNew : Place::kCoarselyNew;
  return surely ? Place::kSurelyNew : Place::kNew;
}

/// How an echo takes part in clusters.
enum class ClusterRole : std::uint8_t {
  kNone,      ///< in none: on the ground, too high, outside the grid, no solid echo
  kConnects,  ///< connects what it touches
  kFollows,   ///< near the ground: belongs to what stands right above it, connects nothing
  kLoose,     ///< in none: alone in its direction while the air is full of such echoes
};

/// One entry per echo; while objects are looked for, points, heights, roles and places have entries of earlier parts of
/// the turn, too, behind those of the cloud itself. Points are the echoes in the grid's window, z up [m].
struct JudgedScan {
  double stamp = 0.0;                                                  ///< [s]
  Eigen::Isometry3d odom_from_points = Eigen::Isometry3d::Identity();  ///< without a rotation
  Eigen::Vector3f sensor = Eigen::Vector3f::Zero();
  double beams_apart = 0.0;             ///< tangent of the angle between beams above one another; 0: not known yet
  std::vector<Eigen::Vector3f> points;  ///< NaN where the echo is none
  std::vector<std::uint8_t> is_echo;
  std::vector<std::uint8_t> is_solid;  ///< an echo that is not the own body's
  std::vector<float> heights;          ///< above the local ground [m]
  bool has_ground = true;              ///< otherwise heights are above the window's lowest corner
  std::vector<ClusterRole> roles;
  std::vector<Place> places;
  std::size_t beside = 0;               ///< entries of earlier parts of the turn
  std::size_t far = 0;                  ///< the last of these: they touch none of the cloud itself
  std::vector<std::uint32_t> together;  ///< by entry beside: what was one object has one number; 0: of none
  bool continues_turn = false;          ///< earlier parts of the turn have been judged

  /// Entries of the cloud itself.
  std::size_t own() const { return points.size() - beside; }
};

}  // namespace donex
