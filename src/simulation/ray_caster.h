// Which solid each ray meets first, without asking all of them.
#pragma once

#include <vector>

#include "simulation/sensor_model.h"
#include "simulation/shape.h"

namespace donex::simulation {

/// A solid during one turn of the sensor; it moves straight on.
struct Target {
  Shape shape;                                         ///< at `time`
  Eigen::Vector3f velocity = Eigen::Vector3f::Zero();  ///< [m/s]
  float time = 0.0f;                                   ///< [s]
};

inline constexpr int kNoTarget = -1;

struct Hit {
  float parameter = kMiss;  ///< level distance in sensor axes [m]
  int target = kNoTarget;
};

/// The sensor while it fires some neighbouring columns.
struct Stretch {
  int first_column;
  int end_column;
  Eigen::Isometry3f sensor;  ///< pose in the middle, in the frame of the targets
  float time;                ///< in the middle [s]
  float movement;            ///< the sensor is never further from the middle pose [m]
  float rotation;            ///< nor turned more [rad]
  float half_duration;       ///< [s]
};

/// Keeps the targets of a stretch by azimuth, nearest first.
class RayCaster {
 public:
  explicit RayCaster(const SensorModel& model);

  /// `targets` must stay until the stretch is cast.
  void prepare(const std::vector<Target>& targets, const Stretch& stretch);

  /// The first hit of every beam of a column, nearer than hits[i].parameter as given.
  void cast(int column, const Eigen::Isometry3f& sensor, float time, std::vector<Hit>& hits) const;

 private:
  /// What a target can cover at most, seen from the sensor.
  struct Extent {
    float near;  ///< level distance
    float slope_low;
    float slope_high;
    int target;
    float azimuth;  ///< of its middle
    float half_angle;
  };
  static Extent extentOf(const Target& target, const Stretch& stretch);
  void distribute(const Extent& extent, const Stretch& stretch);
  int sectorOf(int column) const;
  int columnsAround() const;
  struct Open {
    int first, last;
  };
  Open openSectors(const Stretch& stretch) const;

  const SensorModel& model_;
  const std::vector<Target>* targets_ = nullptr;
  std::vector<Extent> extents_;
  std::vector<std::vector<Extent>> sectors_;
};

}  // namespace donex::simulation
