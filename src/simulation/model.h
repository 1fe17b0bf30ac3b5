// What objects look like: solids around an origin on the ground, x forward.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "simulation/random.h"
#include "simulation/shape.h"

namespace donex::simulation {

/// SemanticKITTI classes of an object at rest and in motion.
struct ObjectClass {
  std::uint32_t at_rest;
  std::uint32_t moving;
};
inline constexpr ObjectClass kCar{10, 252};
inline constexpr ObjectClass kCyclist{31, 253};
inline constexpr ObjectClass kPerson{30, 254};
inline constexpr ObjectClass kBus{13, 257};
inline constexpr ObjectClass kLorry{18, 258};

struct Part {
  Shape shape;  ///< in the model's axes
  float reflectivity = 0.3f;
};

/// How limbs follow the way that is covered.
enum class Gait : std::uint8_t { kNone, kWalk, kPedal };

struct Model {
  ObjectClass object_class = kCar;
  std::vector<Part> parts;
  Gait gait = Gait::kNone;
  double stature = 1.0;  ///< scales the limbs

  /// All parts after `way` [m]: the limbs swing with it.
  std::vector<Part> posed(double way) const;
  /// The box that holds every part at every moment, in the model's axes.
  Eigen::AlignedBox3d box() const;
};

/// The variants differ in shape, size and paint.
Model makeCar(Random& random);
Model makeVan(Random& random);
Model makeLorry(Random& random);
Model makeBus(Random& random);
Model makePerson(Random& random);
Model makeCyclist(Random& random);

}  // namespace donex::simulation
