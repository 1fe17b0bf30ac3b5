// Which sensors a simulated vehicle carries, where each sits, and how far around it looks.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace donex::simulation {

/// A sensor's place, told from that of the scene's own sensor on the roof, in the vehicle's axes.
struct Mounting {
  const char* sensor;  ///< its name; empty: the only one
  double ahead;        ///< [m]
  double above;        ///< [m]
  bool faces_back;
  bool sees_half;  ///< only what lies ahead of it: the vehicle stands in its way behind

  Eigen::Isometry3d baseFromSensor(const Eigen::Isometry3d& base_from_roof) const;
};

struct Rig {
  const char* name;
  const char* meaning;
  std::vector<Mounting> mountings;
};

/// The one place: single front_rear roof_bumper roof_front_rear.
const std::vector<Rig>& rigs();
const std::vector<std::string>& rigNames();
const Rig* findRig(const std::string& name);

}  // namespace donex::simulation
