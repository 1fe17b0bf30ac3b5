#include "simulation/rig.h"

#include "core/pi.h"
#include "simulation/named.h"

namespace donex::simulation {
namespace {

constexpr double kRoofEdge = 0.5;  // [m] from the middle of the roof
// Of a car, from the sensor on its roof (1.1 m before the rear axle, 1.73 m above the ground).
constexpr double kFrontBumper = 2.6, kRearBumper = -2.1, kBumperBelow = -1.13;  // [m]

}  // namespace

Eigen::Isometry3d Mounting::baseFromSensor(const Eigen::Isometry3d& base_from_roof) const {
  Eigen::Isometry3d pose = base_from_roof;
  pose.pretranslate(Eigen::Vector3d(ahead, 0.0, above));
  if (faces_back) pose.rotate(Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitZ()));
  return pose;
}

const std::vector<Rig>& rigs() {
  static const std::vector<Rig> all{
      {"single", "one sensor, on the roof", {{"", 0.0, 0.0, false, false}}},
      {"front_rear",
       "two on the edges of the roof, half a turn each",
       {{"front", kRoofEdge, 0.0, false, true}, {"rear", -kRoofEdge, 0.0, true, true}}},
      {"roof_bumper",
       "one on the roof, one of half a turn on the front bumper",
       {{"roof", 0.0, 0.0, false, false}, {"bumper", kFrontBumper, kBumperBelow, false, true}}},
      {"roof_front_rear",
       "one on the roof, one of half a turn on each bumper",
       {{"roof", 0.0, 0.0, false, false},
        {"front", kFrontBumper, kBumperBelow, false, true},
        {"rear", kRearBumper, kBumperBelow, true, true}}},
  };
  return all;
}

const std::vector<std::string>& rigNames() {
  static const std::vector<std::string> names = namesOf(rigs());
  return names;
}

const Rig* findRig(const std::string& name) { return findNamed(rigs(), name); }

}  // namespace donex::simulation
