#include "simulation/scene.h"

#include <algorithm>
#include <cmath>

#include "core/pi.h"
#include "simulation/simulator.h"

namespace donex::simulation {
namespace {

constexpr double kWheelbase = 2.8;  // [m]
constexpr double kHalfTrack = 0.8;  // [m]

/// Stands on the ground with four wheels: origin under the middle of the rear axle.
Eigen::Isometry3d onWheels(const PathPoint& place, const Ground& ground) {
  const Eigen::Vector2d front = place.position + kWheelbase * place.forward();
  const Eigen::Vector2d side = kHalfTrack * place.left();
  const double rear_left = ground.height(place.position + side);
  const double rear_right = ground.height(place.position - side);
  const double front_left = ground.height(front + side);
  const double front_right = ground.height(front - side);
  const double rear = 0.5 * (rear_left + rear_right);
  const double rise = 0.5 * (front_left + front_right) - rear;
  const double lean = 0.5 * (rear_left + front_left - rear_right - front_right);

  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() << place.position, rear;
  pose.rotate(Eigen::AngleAxisd(place.yaw, Eigen::Vector3d::UnitZ()));
  pose.rotate(Eigen::AngleAxisd(-std::atan2(rise, kWheelbase), Eigen::Vector3d::UnitY()));
  pose.rotate(Eigen::AngleAxisd(std::atan2(lean, 2.0 * kHalfTrack), Eigen::Vector3d::UnitX()));
  return pose;
}

/// Mean curvature around the place: a driver doesn't turn the wheel at once.
double easedCurvature(const Course& course, double time) {
  constexpr double kHalfSpan = 3.0;  // [m]
  const double s = course.start + course.way(time);
  const double turned = course.path->at(s + kHalfSpan).yaw - course.path->at(s - kHalfSpan).yaw;
  return std::remainder(turned, 2.0 * kPi) / (2.0 * kHalfSpan);
}

/// The body on its springs against the wheels.
Eigen::Isometry3d suspension(const Course& course, double time) {
  constexpr double kEase = 0.4;  // [s]
  const double speed = course.speed.speed(time);
  const double acceleration = (course.speed.speed(time + kEase) - course.speed.speed(time - kEase)) / (2.0 * kEase);
  const double lively = std::min(1.0, speed / 3.0);
  const auto wave = [time](double frequency, double phase) { return std::sin(2.0 * kPi * frequency * time + phase); };
  const double heave = lively * (0.010 * wave(1.25, 0.3) + 0.006 * wave(0.7, 1.9));
  const double roll = lively * (0.005 * wave(1.1, 0.0) + 0.004 * wave(0.45, 2.0)) +
                      0.004 * easedCurvature(course, time) * speed * speed;
  const double pitch = lively * (0.004 * wave(1.4, 1.0) + 0.003 * wave(0.6, 4.0)) - 0.006 * acceleration;

  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation().z() = heave;
  pose.rotate(Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()));
  pose.rotate(Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()));
  return pose;
}

}  // namespace

PathPoint Course::at(double time) const {
  const double covered = way(time);
  double aside = 0.0;
  double heading = 0.0;
  if (shift_length > 0.0) {
    const double u = std::clamp((covered - shift_begin) / shift_length, 0.0, 1.0);
    aside = shift * u * u * (3.0 - 2.0 * u);
    heading = std::atan(shift * 6.0 * u * (1.0 - u) / shift_length);
  }
  PathPoint point = path->at(start + (backwards ? -covered : covered), lateral + aside);
  point.yaw += backwards ? -heading : heading;
  if (backwards) {
    point.yaw += kPi;
    point.curvature = -point.curvature;
  }
  return point;
}

double Course::groundSpeed(double time) const {
  const double covered = way(time);
  const double curvature = path->at(start + (backwards ? -covered : covered)).curvature;
  return (1.0 - curvature * lateral) * speed.speed(time);
}

Eigen::Isometry3d poseOf(const Mover& mover, const Ground& ground, double time) {
  constexpr double kReach = 0.8;  // [m]
  const PathPoint place = mover.course.at(time);
  const double rear = ground.height(place.position - kReach * place.forward());
  const double front = ground.height(place.position + kReach * place.forward());
  const bool upright = mover.model.gait == Gait::kWalk;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() << place.position, upright ? ground.height(place.position) : 0.5 * (rear + front);
  pose.rotate(Eigen::AngleAxisd(place.yaw, Eigen::Vector3d::UnitZ()));
  if (!upright) pose.rotate(Eigen::AngleAxisd(-std::atan2(front - rear, 2.0 * kReach), Eigen::Vector3d::UnitY()));
  return pose;
}

std::uint32_t labelOf(const Mover& mover, double time) {
  constexpr int kSteps = 10;
  const auto moves = [&](double when) { return std::abs(mover.course.groundSpeed(when)) > kMovingSpeed; };
  if (moves(time)) return mover.model.object_class.moving;
  for (int i = 1; i <= kSteps; ++i) {
    if (moves(time - kSettleTime * i / kSteps)) return 0;
  }
  return mover.model.object_class.at_rest;
}

Eigen::Isometry3d poseOf(const Ego& ego, const Ground& ground, double time) {
  const Eigen::Isometry3d wheels = onWheels(ego.course.at(time), ground);
  return ego.suspension ? wheels * suspension(ego.course, time) : wheels;
}

}  // namespace donex::simulation
