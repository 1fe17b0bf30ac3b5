#include "simulation/simulated_sensor.h"

#include "simulation/random.h"

namespace donex::simulation {
namespace {

SensorOptions sensorOptions(const SimulatorOptions& options, const Mounting& mounting, std::size_t number) {
  const auto seed = static_cast<std::uint64_t>(options.seed);
  SensorOptions sensor;
  sensor.sees_half = mounting.sees_half;
  sensor.duration = 1.0 / options.scan_rate;
  sensor.distortion = options.distortion;
  sensor.range_noise = options.range_noise;
  sensor.dropout = options.dropout;
  sensor.max_range = options.max_range;
  sensor.seed = number == 0 ? seed : scramble(seed, number);
  return sensor;
}

std::optional<ScanPattern> patternOf(const SimulatorOptions& options, const SensorOptions& sensor) {
  const Pattern pattern = options.chosenPattern();
  if (pattern.kind == PatternKind::kSpinning) return std::nullopt;
  return ScanPattern(pattern, sensor.duration, sensor.seed);
}

SensorModel firstModel(int beams, const std::optional<ScanPattern>& pattern) {
  if (!pattern) return makeSensorModel(beams);
  SensorModel model;
  pattern->aim(0, model);
  return model;
}

}  // namespace

SimulatedSensor::SimulatedSensor(const Scene& scene, const SimulatorOptions& options, const Mounting& mounting,
                                 std::size_t number)
    : scene_(scene),
      name_(mounting.sensor),
      base_from_sensor_(mounting.baseFromSensor(scene.ego.base_from_sensor)),
      options_(sensorOptions(options, mounting, number)),
      pattern_(patternOf(options, options_)),
      model_(firstModel(options.beams == 0 ? scene.beams : options.beams, pattern_)),
      sweep_(scene, base_from_sensor_, model_, options_),
      disturbance_(options.disturbance, options_.seed),
      parts_(options) {}

void SimulatedSensor::measure(double end, std::size_t turn) {
  end_ = end;
  if (pattern_) pattern_->aim(turn, model_);
  sweep_.measure(end, turn, echoes_, labels_);
  disturbance_.apply(turn, echoes_, labels_);
  parts_.cut(echoes_);
}

/// Of its echoes, by its number.
std::vector<std::uint32_t> SimulatedSensor::moverLabels(double time) const {
  std::vector<std::uint32_t> labels;
  for (std::size_t i = 0; i < scene_.movers.size(); ++i) {
    labels.push_back(labelOf(scene_.movers[i], time) | instanceBits(i));
  }
  return labels;
}

void SimulatedSensor::takePart(std::size_t part, SimulatedScan& scan) const {
  const double stamp = parts_.timesOf(part, end_).stamp;
  // What moves at the end of the turn may have stood at the time of the part.
  const std::vector<std::uint32_t> labels = moverLabels(stamp);
  scan.sensor = name_;
  scan.base_from_sensor = baseFromSensor();
  scan.echoes.clear();
  scan.labels.clear();
  for (const std::uint32_t i : parts_.echoesOf(part)) {
    SimulatedEcho echo = echoes_[i];
    if (echo.time < 0.0F) echo.time = static_cast<float>(static_cast<double>(echo.time) + (end_ - stamp));
    scan.echoes.push_back(echo);
    const std::size_t instance = labels_[i] >> 16;
    scan.labels.push_back(instance == 0 ? labels_[i] : labels[instance - 1]);
  }
}

}  // namespace donex::simulation
