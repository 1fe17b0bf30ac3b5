// A scan as the steps of evidence see it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

namespace donex {

/// What the grid knows of the place an echo hit. A new place may be several of the last three at once.
enum class Place : std::uint8_t {
  kUnobserved = 0,  ///< hit for the first time not long ago, and never seen free before; or not asked
  kAtSurface = 1,   ///< a surface's flicker: it touched a settled one when it was first hit, or scans had seen one here
  kSettled = 2,     ///< occupied for longer than the birth window
  kNew = 8,         ///< occupied not long ago after it had been seen free: something came
  kSurelyNew = kNew | 1,    ///< and most scans that knew anything of it had seen it free
  kCoarselyNew = kNew | 2,  ///< but beams so far apart had seen it free that something low may have stood between them
  kLingering = kNew | 4,    ///< but half a second ago or more, or out of view for so long: it may have stopped
};

constexpr bool is(Place place, Place kind) {
  return (static_cast<unsigned>(place) & static_cast<unsigned>(kind)) == static_cast<unsigned>(kind);
}
constexpr Place both(Place a, Place b) {
  return static_cast<Place>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}
constexpr bool isNewPlace(Place place) { return is(place, Place::kNew); }

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
