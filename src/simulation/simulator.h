// A LiDAR on a vehicle in a scripted scene: scans with ground truth, and the odometry a real vehicle would report.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "donex/motion/ego_motion.h"
#include "donex/scan.h"
#include "simulation/simulated_echo.h"
#include "simulation/simulator_options.h"

namespace donex::simulation {

/// One cloud of a sensor: a turn, or a part of one.
struct SimulatedScan {
  double stamp = 0.0;  ///< that its echoes are given for [s]
  double sent = 0.0;   ///< the stamp, but of parts without distortion: those come one after the other [s]
  std::string sensor;  ///< its name in the rig; empty for the only one
  std::vector<SimulatedEcho> echoes;
  /// One per echo, as SemanticKITTI has them: lower 16 bits the class, upper 16 the moving object's number.
  /// 252 car or van, 253 cyclist, 254 person, 257 bus, 258 lorry: faster than kMovingSpeed by itself.
  /// 0, not judged: slower than that now, but not for all of the last kSettleTime.
  /// Anything else is static: 10 car, 30 person, 40 road, 48 pavement, 50 building, 70 vegetation, 80 pole ...
  std::vector<std::uint32_t> labels;
  Eigen::Isometry3d odom_from_base = Eigen::Isometry3d::Identity();  ///< true motion, at `stamp`
  Eigen::Isometry3d base_from_sensor = Eigen::Isometry3d::Identity();
  /// What the odometry has said since the scan before, oldest first; stamps up to `sent` (+ stamp_offset). Scans of
  /// the same time: the first of them.
  std::vector<OdometrySample> odometry;

  /// As the core takes it, with the true motion.
  Scan coreScan() const;
};

/// An object that can move by itself, at one moment.
struct MoverTruth {
  std::uint32_t label = 0;                                          ///< of its echoes
  Eigen::Isometry3d odom_from_box = Eigen::Isometry3d::Identity();  ///< x forward, at the box' centre
  Eigen::Vector3d size = Eigen::Vector3d::Zero();                   ///< of the box that holds every part of it [m]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();               ///< odometry frame [m/s]
};

inline constexpr double kMovingSpeed = 0.3;  ///< an object faster than this moves [m/s]
inline constexpr double kSettleTime = 1.0;   ///< slower for this long: it stands [s]

/// intersection street motorway bend, and the hard cases; in the order of the documentation.
const std::vector<std::string>& sceneNames();
bool isScene(const std::string& name);
/// Whether the sensor is on a vehicle. Throws std::invalid_argument for an unknown name.
bool hasVehicle(const std::string& scene);
/// The message for a scene that isn't there: names those that are.
std::string unknownScene(const std::string& name);
/// Every fault of a drive, one sentence each: unknown scene, options; empty when the drive is possible.
std::vector<std::string> faultsOf(const std::string& scene, const SimulatorOptions& options);
/// One sentence. Throws std::invalid_argument for an unknown name.
std::string sceneMeaning(const std::string& scene);

/// Not thread-safe. Every scene goes on for as long as it is asked to.
class Simulator {
 public:
  /// Throws std::invalid_argument that lists every fault (unknown scene, options).
  explicit Simulator(const std::string& scene, const SimulatorOptions& options = {});
  ~Simulator();
  Simulator(Simulator&&) noexcept;
  Simulator& operator=(Simulator&&) noexcept;

  /// The next scan: turn after turn, part after part, of each sensor at the same time. False when the duration is over,
  /// then `scan` is untouched.
  bool next(SimulatedScan& scan);

  /// True motion at any moment of the scene [s].
  Eigen::Isometry3d odomFromBase(double stamp) const;
  std::size_t sensorCount() const;
  /// Empty for the only sensor.
  const std::string& sensorName(std::size_t sensor) const;
  Eigen::Isometry3d baseFromSensor(std::size_t sensor = 0) const;
  /// The moving objects; `number` counts from 0, one less than in the labels.
  std::size_t moverCount() const;
  MoverTruth mover(std::size_t number, double stamp) const;

  int beams() const;    ///< rays a firing
  int columns() const;  ///< firings a turn: beams() x columns() rays
  /// Parts of a turn, of every sensor.
  std::size_t scansPerTurn() const;
  /// Scans in the whole duration; 0: endless.
  std::size_t size() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace donex::simulation
