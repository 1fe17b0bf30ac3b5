#include "simulation/sweep.h"

#include <algorithm>
#include <cmath>

#include "core/pi.h"
#include "donex/motion/rigid_motion.h"
#include "simulation/random.h"

namespace donex::simulation {
namespace {

constexpr int kStretches = 12;  // of a turn with distortion: the vehicle moves little in each
constexpr int kKnots = 24;      // poses a turn; in between the motion is straight on
constexpr int kGround = -2;     // as Hit::target
constexpr float kGroundReflectivity = 0.16f;
constexpr double kFaintest = 3.5e-7;    // of a surface's brightness over its squared distance, half lost [1/m^2]
constexpr double kWindFrequency = 0.6;  // [Hz]

}  // namespace

Sweep::Sweep(const Scene& scene, const Eigen::Isometry3d& base_from_sensor, const SensorModel& model,
             const SensorOptions& options)
    : scene_(scene),
      base_from_sensor_(base_from_sensor),
      model_(model),
      options_(options),
      window_(scene.ground),
      caster_(model) {
  hits_.resize(static_cast<std::size_t>(model.beams()));
}

/// `after` the turn's end, so 0 or negative [s].
Eigen::Isometry3d Sweep::sensorAt(double after) const {
  if (!options_.distortion) return knots_.back();
  const double at = std::clamp(1.0 + after / options_.duration, 0.0, 1.0) * kKnots;
  const auto i = std::min(static_cast<std::size_t>(at), static_cast<std::size_t>(kKnots - 1));
  return interpolate(knots_[i], knots_[i + 1], at - static_cast<double>(i));
}

void Sweep::gatherFixtures() {
  for (std::size_t i = 0; i < scene_.fixtures.size(); ++i) {
    const Fixture& fixture = scene_.fixtures[i];
    const Eigen::Vector3d offset = fixture.center - anchor_;
    const double reach = options_.max_range + static_cast<double>(fixture.shape.half.norm()) + 5.0;
    if (offset.squaredNorm() > reach * reach) continue;
    Target target;
    target.shape = fixture.shape;
    target.shape.center = offset.cast<float>();
    if (fixture.sway > 0.0f) {
      const double phase = 2.0 * kPi * kWindFrequency * time_ + static_cast<double>(i);
      const Eigen::Vector3f swing(0.8f * fixture.sway, 0.6f * fixture.sway, 0.0f);
      target.shape.center += static_cast<float>(std::sin(phase)) * swing;
      target.velocity = static_cast<float>(2.0 * kPi * kWindFrequency * std::cos(phase)) * swing;
    }
    targets_.push_back(target);
    surfaces_.push_back({fixture.label, fixture.reflectivity});
  }
}

/// When the beam passes the place, after the turn's end [s].
double Sweep::passingTime(const Eigen::Vector3d& place) const {
  if (!options_.distortion) return 0.0;
  const Eigen::Vector3d seen = sensorAt(-0.5 * options_.duration).inverse() * place;
  const double turned = (kPi - std::atan2(seen.y(), seen.x())) / (2.0 * kPi);
  return options_.duration * (turned - 1.0);
}

void Sweep::gatherMover(std::size_t index) {
  const Mover& mover = scene_.movers[index];
  const double after = passingTime(poseOf(mover, scene_.ground, time_ - 0.5 * options_.duration).translation());
  const Eigen::Isometry3d pose = poseOf(mover, scene_.ground, time_ + after);
  const Eigen::Matrix3f axes = pose.linear().cast<float>();
  Target target;
  target.time = static_cast<float>(after);
  target.velocity = axes.col(0) * static_cast<float>(mover.course.groundSpeed(time_ + after));
  const std::uint32_t label = labelOf(mover, time_) | instanceBits(index);
  for (const Part& part : mover.model.posed(mover.course.way(time_ + after))) {
    target.shape = part.shape;
    target.shape.axes = axes * part.shape.axes;
    target.shape.center = (pose * part.shape.center.cast<double>() - anchor_).cast<float>();
    targets_.push_back(target);
    surfaces_.push_back({label, part.reflectivity});
  }
}

void Sweep::gatherMovers() {
  constexpr double kLargest = 15.0;  // [m]
  for (std::size_t i = 0; i < scene_.movers.size(); ++i) {
    const Eigen::Vector2d place = scene_.movers[i].course.at(time_).position;
    if ((place - anchor_.head<2>()).norm() < options_.max_range + kLargest) gatherMover(i);
  }
}

Stretch Sweep::stretchOf(int first_column, int end_column) const {
  const double per_column = options_.duration / model_.columns();
  const auto time_of = [&](int column) { return options_.distortion ? per_column * column - options_.duration : 0.0; };
  const double middle = 0.5 * (time_of(first_column) + time_of(end_column));
  Eigen::Isometry3d pose = sensorAt(middle);
  Stretch stretch{first_column, end_column, {}, static_cast<float>(middle), 0.0f, 0.0f, 0.0f};
  for (const int end : {first_column, end_column}) {
    const Eigen::Isometry3d moved = pose.inverse() * sensorAt(time_of(end));
    stretch.movement = std::max(stretch.movement, static_cast<float>(1.5 * moved.translation().norm()));
    stretch.rotation = std::max(stretch.rotation, static_cast<float>(1.5 * Eigen::AngleAxisd(moved.linear()).angle()));
  }
  stretch.half_duration = static_cast<float>(middle - time_of(first_column));
  pose.translation() -= anchor_;
  stretch.sensor = pose.cast<float>();
  return stretch;
}

Eigen::Vector3f Sweep::normalOf(const Echo& echo, const Eigen::Vector3f& point,
                                const Eigen::Vector3f& direction) const {
  if (echo.hit.target == kGround) {
    const Eigen::Vector2d place = point.head<2>().cast<double>() + anchor_.head<2>();
    return window_.normal(place.x(), place.y());
  }
  return normalAt(targets_[static_cast<std::size_t>(echo.hit.target)].shape, point, direction);
}

void Sweep::receive(const Echo& echo) {
  const float slope = model_.slopesOf(echo.column)[static_cast<std::size_t>(echo.beam)];
  const Eigen::Vector2d heading = model_.headings[static_cast<std::size_t>(echo.column)];
  const Eigen::Vector3d ray(heading.x(), heading.y(), slope);
  const double length = ray.norm();
  const double range = static_cast<double>(echo.hit.parameter) * length;
  if (range > options_.max_range) return;

  const Eigen::Vector3d place = echo.sensor * (static_cast<double>(echo.hit.parameter) * ray);
  const Eigen::Vector3f direction = (echo.sensor.linear() * (ray / length)).cast<float>();
  const Eigen::Vector3f normal = normalOf(echo, (place - anchor_).cast<float>(), direction);
  const double facing = std::abs(normal.dot(direction));
  const bool on_ground = echo.hit.target == kGround;
  const Surface surface = on_ground ? Surface{window_.label(place.x(), place.y()), kGroundReflectivity}
                                    : surfaces_[static_cast<std::size_t>(echo.hit.target)];

  const auto ray_number = static_cast<std::uint64_t>(echo.column) * static_cast<std::uint64_t>(model_.beams()) +
                          static_cast<std::uint64_t>(echo.beam);
  const std::uint64_t bits = scramble(noise_seed_ ^ ray_number);
  const double brightness = static_cast<double>(surface.reflectivity) * facing / (range * range);
  const double kept = (1.0 - std::exp2(-brightness / kFaintest)) * (1.0 - options_.dropout);
  if (static_cast<double>(bits >> 40) * 0x1p-24 >= kept) return;

  const double measured = range + options_.range_noise * gaussianFrom(scramble(bits));
  if (measured < static_cast<double>(model_.min_range) || measured > options_.max_range) return;
  const double shine = 0.9 + 0.2 * static_cast<double>(bits & 0xFFFF) / 65536.0;
  const double intensity = std::min(1.0, static_cast<double>(surface.reflectivity) * (0.3 + 0.7 * facing) * shine);
  const double time = options_.distortion ? options_.duration * ((echo.column + 0.5) / model_.columns() - 1.0) : 0.0;
  echoes_->push_back({(measured / length * ray).cast<float>(), static_cast<float>(intensity), static_cast<float>(time),
                      static_cast<std::uint16_t>(model_.ring(echo.column, echo.beam))});
  labels_->push_back(surface.label);
}

bool Sweep::sees(int column) const {
  return !options_.sees_half || model_.headings[static_cast<std::size_t>(column)].x() >= 0.0;
}

void Sweep::fire(int column) {
  const double after = options_.distortion ? options_.duration * ((column + 0.5) / model_.columns() - 1.0) : 0.0;
  const Eigen::Isometry3d sensor = sensorAt(after);
  const Eigen::Vector3d forward = sensor.linear().leftCols<2>() * model_.headings[static_cast<std::size_t>(column)];
  window_.meet({sensor.translation(), forward, sensor.linear().col(2), model_.slopesOf(column)}, ground_);
  for (std::size_t i = 0; i < hits_.size(); ++i) hits_[i] = {ground_[i], ground_[i] == kMiss ? kNoTarget : kGround};

  Eigen::Isometry3d relative = sensor;
  relative.translation() -= anchor_;
  caster_.cast(column, relative.cast<float>(), static_cast<float>(after), hits_);
  for (std::size_t i = 0; i < hits_.size(); ++i) {
    if (hits_[i].target != kNoTarget) receive({sensor, column, static_cast<int>(i), hits_[i]});
  }
}

void Sweep::measure(double time, std::size_t turn, std::vector<SimulatedEcho>& echoes,
                    std::vector<std::uint32_t>& labels) {
  time_ = time;
  noise_seed_ = scramble(options_.seed, turn + 1);
  echoes_ = &echoes;
  labels_ = &labels;
  echoes.clear();
  labels.clear();
  targets_.clear();
  surfaces_.clear();
  knots_.clear();
  for (int i = options_.distortion ? 0 : kKnots; i <= kKnots; ++i) {
    const double at = time - options_.duration * (1.0 - static_cast<double>(i) / kKnots);
    knots_.push_back(poseOf(scene_.ego, scene_.ground, at) * base_from_sensor_);
  }
  anchor_ = knots_.back().translation();
  window_.moveTo(anchor_.head<2>());
  gatherFixtures();
  gatherMovers();

  const int stretches = options_.distortion ? kStretches : 1;
  for (int i = 0; i < stretches; ++i) {
    const Stretch stretch = stretchOf(model_.columns() * i / stretches, model_.columns() * (i + 1) / stretches);
    caster_.prepare(targets_, stretch);
    for (int column = stretch.first_column; column < stretch.end_column; ++column) {
      if (sees(column)) fire(column);
    }
  }
}

}  // namespace donex::simulation
