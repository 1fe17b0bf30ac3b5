// One turn of the sensor through a scene: echoes with noise, each with its label.
#pragma once

#include <vector>

#include "simulation/ground_window.h"
#include "simulation/ray_caster.h"
#include "simulation/scene.h"
#include "simulation/simulator.h"

namespace donex::simulation {

struct SensorOptions {
  bool sees_half = false;  ///< only what lies ahead of it
  double duration = 0.1;   ///< of a turn [s]
  bool distortion = false;
  double range_noise = 0.015;  ///< [m]
  double dropout = 0.01;
  double max_range = 120.0;  ///< [m]
  std::uint64_t seed = 1;
};

/// The number of a mover in the upper half of its labels; 0 is no mover.
inline std::uint32_t instanceBits(std::size_t mover) { return (static_cast<std::uint32_t>(mover + 1) & 0xFFFFu) << 16; }

class Sweep {
 public:
  /// The first three must outlive it.
  Sweep(const Scene& scene, const Eigen::Isometry3d& base_from_sensor, const SensorModel& model,
        const SensorOptions& options);

  /// The turn that is complete at `time` [s]; `turn` numbers it for the noise. Overwrites both.
  void measure(double time, std::size_t turn, std::vector<SimulatedEcho>& echoes, std::vector<std::uint32_t>& labels);

 private:
  /// What a target is made of.
  struct Surface {
    std::uint32_t label;
    float reflectivity;
  };
  struct Echo {
    const Eigen::Isometry3d& sensor;  // when it was fired
    int column;
    int beam;
    Hit hit;
  };

  Eigen::Isometry3d sensorAt(double after) const;
  void gatherFixtures();
  void gatherMovers();
  void gatherMover(std::size_t index);
  double passingTime(const Eigen::Vector3d& place) const;
  Stretch stretchOf(int first_column, int end_column) const;
  bool sees(int column) const;
  void fire(int column);
  void receive(const Echo& echo);
  Eigen::Vector3f normalOf(const Echo& echo, const Eigen::Vector3f& point, const Eigen::Vector3f& direction) const;

  const Scene& scene_;
  const Eigen::Isometry3d& base_from_sensor_;
  const SensorModel& model_;
  SensorOptions options_;
  GroundWindow window_;
  RayCaster caster_;

  double time_ = 0.0;                                 // when the turn is complete
  std::uint64_t noise_seed_ = 0;                      // of the turn
  std::vector<Eigen::Isometry3d> knots_;              // sensor poses in the scene, evenly over the turn
  Eigen::Vector3d anchor_ = Eigen::Vector3d::Zero();  // targets are kept relative to it
  std::vector<Target> targets_;
  std::vector<Surface> surfaces_;  // one per target
  std::vector<Hit> hits_;
  std::vector<float> ground_;
  std::vector<SimulatedEcho>* echoes_ = nullptr;
  std::vector<std::uint32_t>* labels_ = nullptr;
};

}  // namespace donex::simulation
