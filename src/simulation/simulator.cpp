#include "simulation/simulator.h"

#include <cmath>
#include <optional>
#include <stdexcept>

#include "simulation/disturbance.h"
#include "simulation/odometry_error.h"
#include "simulation/scan_pattern.h"
#include "simulation/scene.h"
#include "simulation/sweep.h"

namespace donex::simulation {

std::string faultsOf(const std::string& scene, const SimulatorOptions& options) {
  std::vector<std::string> faults = options.faults();
  if (!isScene(scene)) faults.push_back(unknownScene(scene));
  std::string text;
  for (const std::string& fault : faults) text += (text.empty() ? "" : "\n") + fault;
  return text;
}

Scan SimulatedScan::coreScan() const {
  Scan scan;
  scan.stamp = stamp;
  scan.base_from_sensor = base_from_sensor;
  scan.odom_from_base = odom_from_base;
  scan.echoes.reserve(echoes.size());
  for (const SimulatedEcho& echo : echoes) scan.echoes.push_back(echo.position);
  return scan;
}

namespace {

/// Checks everything that can be wrong before anything is built.
SimulatorOptions checked(const std::string& scene, const SimulatorOptions& options) {
  const std::string faults = faultsOf(scene, options);
  if (!faults.empty()) throw std::invalid_argument(faults);
  return options;
}

SensorOptions sensorOptions(const SimulatorOptions& options) {
  SensorOptions sensor;
  sensor.duration = 1.0 / options.scan_rate;
  sensor.distortion = options.distortion;
  sensor.range_noise = options.range_noise;
  sensor.dropout = options.dropout;
  sensor.max_range = options.max_range;
  sensor.seed = static_cast<std::uint64_t>(options.seed);
  return sensor;
}

std::optional<ScanPattern> patternOf(const SimulatorOptions& options) {
  const Pattern pattern = options.chosenPattern();
  if (pattern.kind == PatternKind::kSpinning) return std::nullopt;
  return ScanPattern(pattern, 1.0 / options.scan_rate, static_cast<std::uint64_t>(options.seed));
}

SensorModel firstModel(const SimulatorOptions& options, const Scene& scene, const std::optional<ScanPattern>& pattern) {
  if (!pattern) return makeSensorModel(options.beams == 0 ? scene.beams : options.beams);
  SensorModel model;
  pattern->aim(0, model);
  return model;
}

/// Heading and place of the vehicle at the start; the vertical stays the vertical.
Eigen::Isometry3d odomFrom(const Eigen::Isometry3d& start) {
  const double yaw = std::atan2(start.linear()(1, 0), start.linear()(0, 0));
  Eigen::Isometry3d scene_from_odom = Eigen::Isometry3d::Identity();
  scene_from_odom.translation() = start.translation();
  scene_from_odom.rotate(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
  return scene_from_odom.inverse();
}

}  // namespace

struct Simulator::State {
  State(const std::string& name, const SimulatorOptions& given)
      : options(checked(name, given)),
        scene(makeScene(name, static_cast<std::uint64_t>(given.seed))),
        pattern(patternOf(given)),
        sensor(firstModel(given, scene, pattern)),
        sweep(scene, sensor, sensorOptions(given)),
        odometry_error(given.odometry, scramble(static_cast<std::uint64_t>(given.seed), 0x0D0)),
        odom_from_scene(odomFrom(poseOf(scene.ego, scene.ground, 0.0))),
        next_sample(-given.odometry.early()) {}

  double period() const { return 1.0 / options.scan_rate; }
  Eigen::Isometry3d odomFromBase(double time) const { return odom_from_scene * poseOf(scene.ego, scene.ground, time); }
  Twist twist(double time) const;
  void report(double until, std::vector<OdometrySample>& samples);

  SimulatorOptions options;
  Scene scene;
  std::optional<ScanPattern> pattern;  // not of a spinning sensor
  SensorModel sensor;                  // of the scan that comes
  Sweep sweep;
  OdometryError odometry_error;
  Eigen::Isometry3d odom_from_scene;
  long next_sample;  // counted from the scene's beginning
  std::size_t next_scan = 0;
};

Twist Simulator::State::twist(double time) const {
  constexpr double kHalfStep = 1e-3;  // [s]
  const Eigen::Isometry3d moved = odomFromBase(time - kHalfStep).inverse() * odomFromBase(time + kHalfStep);
  const Eigen::AngleAxisd turned(moved.linear());
  return {moved.translation() / (2.0 * kHalfStep), turned.angle() * turned.axis() / (2.0 * kHalfStep)};
}

void Simulator::State::report(double until, std::vector<OdometrySample>& samples) {
  constexpr double kRounding = 1e-9;  // [s]
  samples.clear();
  for (;; ++next_sample) {
    const double time = static_cast<double>(next_sample) / options.odometry.rate;
    if (time > until + kRounding) return;
    samples.push_back(odometry_error.report(options.start_stamp + time, odomFromBase(time), twist(time)));
  }
}

Simulator::Simulator(const std::string& scene, const SimulatorOptions& options)
    : state_(std::make_unique<State>(scene, options)) {}
Simulator::~Simulator() = default;
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;

std::size_t Simulator::size() const { return state_->options.scans(); }

bool Simulator::next(SimulatedScan& scan) {
  State& state = *state_;
  const bool over = state.options.duration > 0.0 && state.next_scan >= size();
  if (over) return false;
  const double time = static_cast<double>(state.next_scan + 1) * state.period();
  scan.stamp = state.options.start_stamp + time;
  scan.odom_from_base = state.odomFromBase(time);
  scan.base_from_sensor = state.scene.ego.base_from_sensor;
  if (state.pattern) state.pattern->aim(state.next_scan, state.sensor);
  state.sweep.measure(time, state.next_scan, scan.echoes, scan.labels);
  const Disturbance disturbance(state.options.disturbance, static_cast<std::uint64_t>(state.options.seed));
  disturbance.apply(state.next_scan, scan.echoes, scan.labels);
  state.report(time, scan.odometry);
  ++state.next_scan;
  return true;
}

Eigen::Isometry3d Simulator::odomFromBase(double stamp) const {
  return state_->odomFromBase(stamp - state_->options.start_stamp);
}

Eigen::Isometry3d Simulator::baseFromSensor() const { return state_->scene.ego.base_from_sensor; }

std::size_t Simulator::moverCount() const { return state_->scene.movers.size(); }

MoverTruth Simulator::mover(std::size_t number, double stamp) const {
  const double time = stamp - state_->options.start_stamp;
  const Mover& mover = state_->scene.movers.at(number);
  const Eigen::AlignedBox3d box = mover.model.box();
  MoverTruth truth;
  truth.label = labelOf(mover, time) | instanceBits(number);
  truth.odom_from_box = state_->odom_from_scene * poseOf(mover, state_->scene.ground, time);
  truth.velocity = truth.odom_from_box.linear().col(0) * mover.course.groundSpeed(time);
  truth.odom_from_box.translate(box.center());
  truth.size = box.sizes();
  return truth;
}

int Simulator::beams() const { return state_->sensor.beams(); }
int Simulator::columns() const { return state_->sensor.columns(); }

}  // namespace donex::simulation
