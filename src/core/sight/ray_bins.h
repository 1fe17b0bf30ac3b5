// The bins of directions, as the index of rays fills and reads them.
#pragma once

namespace donex {

constexpr int kAcross = 512;  // bins across one side of the prism
constexpr int kUp = 64;       // bins of height
constexpr int kBins = 4 * kAcross * kUp;
constexpr int kLanes = 8;            // rays that are looked at together
constexpr float kStraightUp = 1e9F;  // tangent of straight up, and beyond any other

}  // namespace donex
