// The scenes, each built from its seed.
#pragma once

#include "scene_builder.h"

namespace donex::simulation {

Scene makeIntersection(std::uint64_t seed);
Scene makeStreet(std::uint64_t seed);
Scene makeMotorway(std::uint64_t seed);
Scene makeBend(std::uint64_t seed);

}  // namespace donex::simulation
