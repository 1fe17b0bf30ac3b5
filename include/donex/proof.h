// How the motion of an object was proven.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace donex {

/// The proof of motion that held (algorithm: "Proofs of motion").
enum class Proof : std::uint8_t {
  kNone,            ///< none: it stands, as far as is known
  kEnteredFree,     ///< enough of its echoes are where earlier scans saw free space
  kRearReceded,     ///< the place where its echoes were is seen free now
  kEndsMoved,       ///< a little of both: the ends of a long vehicle that passes by
  kShapeElsewhere,  ///< its former shape fits it at another place, and is gone from the old one
  kMovedBefore,     ///< it was proven to move not long ago
  kPartOfMoving,    ///< it lies within the prediction of a large object that is proven to move as a whole
  kAlone,           ///< no objects are formed: the echo's place was free before
};
constexpr std::size_t kProofs = 8;

inline const char* nameOf(Proof proof) {
  constexpr std::array<const char*, kProofs> kNames{
      "none",         "entered_free",   "rear_receded", "ends_moved", "shape_elsewhere",
      "moved_before", "part_of_moving", "alone"};
  return kNames[static_cast<std::size_t>(proof)];
}

}  // namespace donex
