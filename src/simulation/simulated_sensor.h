// One of the sensors that a simulated vehicle carries: its turns through the scene, in parts.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "simulation/disturbance.h"
#include "simulation/rig.h"
#include "simulation/scan_pattern.h"
#include "simulation/scene.h"
#include "simulation/sweep.h"
#include "simulation/turn_parts.h"

namespace donex::simulation {

class SimulatedSensor {
 public:
  /// `number` counts the sensors of a rig: each has its own noise. The scene must outlive it.
  SimulatedSensor(const Scene& scene, const SimulatorOptions& options, const Mounting& mounting, std::size_t number);
  SimulatedSensor(const SimulatedSensor&) = delete;
  SimulatedSensor& operator=(const SimulatedSensor&) = delete;

  const std::string& name() const { return name_; }
  const Eigen::Isometry3d& baseFromSensor() const { return base_from_sensor_; }
  const SensorModel& model() const { return model_; }

  /// The turn that is complete at `end` [s]; `turn` numbers it for the noise.
  void measure(double end, std::size_t turn);
  /// A part of that turn: sets the scan's echoes, their labels, and where the sensor sits.
  void takePart(std::size_t part, SimulatedScan& scan) const;

 private:
  std::vector<std::uint32_t> moverLabels(double time) const;

  const Scene& scene_;
  std::string name_;
  Eigen::Isometry3d base_from_sensor_;
  SensorOptions options_;
  std::optional<ScanPattern> pattern_;  // not of a spinning sensor
  SensorModel model_;                   // of the turn measured
  Sweep sweep_;
  Disturbance disturbance_;
  TurnParts parts_;
  double end_ = 0.0;  // of the turn [s]
  std::vector<SimulatedEcho> echoes_;
  std::vector<std::uint32_t> labels_;
};

}  // namespace donex::simulation
