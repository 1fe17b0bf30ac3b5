#include "simulation/simulator.h"

#include <cmath>
#include <stdexcept>

#include "simulation/odometry_error.h"
#include "simulation/scene.h"
#include "simulation/simulated_sensor.h"

namespace donex::simulation {

std::vector<std::string> faultsOf(const std::string& scene, const SimulatorOptions& options) {
  std::vector<std::string> faults = options.faults();
  if (!isScene(scene)) {
    faults.push_back(unknownScene(scene));
  } else if (faults.empty() && options.mountings().size() > 1 && !hasVehicle(scene)) {
    faults.push_back(scene + " has one sensor and no vehicle: not with a rig of several");
  }
  return faults;
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
  std::string text;
  for (const std::string& fault : faultsOf(scene, options)) text += (text.empty() ? "" : "\n") + fault;
  if (!text.empty()) throw std::invalid_argument(text);
  return options;
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
        parts(given),
        odometry_error(given.odometry, scramble(static_cast<std::uint64_t>(given.seed), 0x0D0)),
        odom_from_scene(odomFrom(poseOf(scene.ego, scene.ground, 0.0))),
        next_sample(-given.odometry.early()) {
    const std::vector<Mounting>& mountings = options.mountings();
    for (std::size_t i = 0; i < mountings.size(); ++i) {
      sensors.push_back(std::make_unique<SimulatedSensor>(scene, options, mountings[i], i));
    }
  }

  double period() const { return 1.0 / options.scan_rate; }
  Eigen::Isometry3d odomFromBase(double time) const { return odom_from_scene * poseOf(scene.ego, scene.ground, time); }
  Twist twist(double time) const;
  void report(double until, std::vector<OdometrySample>& samples);

  SimulatorOptions options;
  Scene scene;
  TurnParts parts;
  std::vector<std::unique_ptr<SimulatedSensor>> sensors;
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

std::size_t Simulator::scansPerTurn() const { return state_->parts.count() * sensorCount(); }
std::size_t Simulator::size() const { return state_->options.turns() * scansPerTurn(); }

bool Simulator::next(SimulatedScan& scan) {
  State& state = *state_;
  const bool over = state.options.duration > 0.0 && state.next_scan >= size();
  if (over) return false;
  const std::size_t turn = state.next_scan / scansPerTurn(), place = state.next_scan % scansPerTurn();
  const double end = static_cast<double>(turn + 1) * state.period();
  if (place == 0) {
    for (const auto& sensor : state.sensors) sensor->measure(end, turn);
  }
  const std::size_t part = place / sensorCount();
  const PartTimes times = state.parts.timesOf(part, end);
  scan.stamp = state.options.start_stamp + times.stamp;
  scan.sent = state.options.start_stamp + times.sent;
  scan.odom_from_base = state.odomFromBase(times.stamp);
  state.sensors[place % sensorCount()]->takePart(part, scan);
  state.report(times.sent, scan.odometry);
  ++state.next_scan;
  return true;
}

Eigen::Isometry3d Simulator::odomFromBase(double stamp) const {
  return state_->odomFromBase(stamp - state_->options.start_stamp);
}

std::size_t Simulator::sensorCount() const { return state_->sensors.size(); }

const std::string& Simulator::sensorName(std::size_t sensor) const { return state_->sensors.at(sensor)->name(); }

Eigen::Isometry3d Simulator::baseFromSensor(std::size_t sensor) const {
  return state_->sensors.at(sensor)->baseFromSensor();
}

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

int Simulator::beams() const { return state_->sensors.front()->model().beams(); }
int Simulator::columns() const { return state_->sensors.front()->model().columns(); }

}  // namespace donex::simulation
