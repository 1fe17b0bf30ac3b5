// Why an echo got its label, and what the grid remembers: for people who look at it, not for the algorithm.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace donex {

/// Why an echo is dynamic or static.
enum class EchoReason : std::uint8_t {
  kNoEcho,      ///< static: nothing came back, or from too far
  kOutside,     ///< static: outside the region of interest or the grid
  kGround,      ///< static: on the local ground
  kUnobserved,  ///< static: the grid never saw this place free before
  kSettled,     ///< static: the place has been occupied for longer, or belongs to a surface that has
  kNewAlone,    ///< static: the place was free before, but what stands there is no moving object
  kMoving,      ///< dynamic
  kOwnBody,     ///< static: the vehicle itself
  kLoose,       ///< static: alone in its direction while the air is full of such echoes
};
constexpr std::size_t kEchoReasons = 9;

inline const char* describe(EchoReason reason) {
  constexpr std::array<const char*, kEchoReasons> kWords{
      "no echo", "outside the grid", "ground", "never seen free", "occupied for longer", "new, but no object",
      "moving",  "own body",         "loose"};
  return kWords[static_cast<std::size_t>(reason)];
}

/// Remembered cells without an echo in the last scan: centres in the odometry frame [m].
struct MemoryCells {
  std::vector<Eigen::Vector3f> shadowed;      ///< still remembered: they may be hidden (paper: shadowing)
  std::vector<Eigen::Vector3f> seen_through;  ///< the sensor sees through them: an echo there is new (de-shadowing)
};

}  // namespace donex
