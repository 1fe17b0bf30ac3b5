// The scenes, each built from its seed.
#pragma once

#include "simulation/scene_builder.h"

namespace donex::simulation {

Scene makeIntersection(std::uint64_t seed);
Scene makeStreet(std::uint64_t seed);
Scene makeMotorway(std::uint64_t seed);
Scene makeBend(std::uint64_t seed);
Scene makeLeadVehicle(std::uint64_t seed);
Scene makeOncoming(std::uint64_t seed);
Scene makePedestrianSlow(std::uint64_t seed);
Scene makeCrowd(std::uint64_t seed);
Scene makeStopAndGo(std::uint64_t seed);
Scene makeParkedCarLeaves(std::uint64_t seed);
Scene makeFoliage(std::uint64_t seed);
Scene makeFences(std::uint64_t seed);
Scene makeBridges(std::uint64_t seed);
Scene makeSlope(std::uint64_t seed);
Scene makeTurning(std::uint64_t seed);
Scene makeStandstillStart(std::uint64_t seed);
Scene makeQueue(std::uint64_t seed);
Scene makeDoors(std::uint64_t seed);
Scene makeFarPeople(std::uint64_t seed);
Scene makeCorners(std::uint64_t seed);
Scene makeEmptyRoom(std::uint64_t seed);

}  // namespace donex::simulation
