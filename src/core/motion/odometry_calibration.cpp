#include "core/motion/odometry_calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/motion/odometry_correction.h"
#include "core/pi.h"

namespace donex {
namespace {

constexpr double kLeastWay = 10.0;    // [m] without which neither mounting nor scale show
constexpr double kSureOffset = 0.05;  // [s] a less certain offset is none
constexpr double kMostOffset = 0.29;  // [s] at the end of what is tried nothing is known
constexpr double kDegrees = 180.0 / kPi;

template <class... Values>
std::string textOf(const char* format, Values... values) {
  std::array<char, 240> text{};
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

/// Mean and its deviation of what each window says; windows overlap, so that few of them are independent.
template <class OfWindow>
CalibrationFigure figureOf(const std::vector<ComparedTracks::Motions>& motions, double mean, double independent,
                           const OfWindow& of_window) {
  double weights = 0.0, squares = 0.0;
  for (const ComparedTracks::Motions& motion : motions) {
    const double weight = motion.found.squaredNorm(), error = of_window(motion) - mean;
    weights += weight;
    squares += weight * error * error;
  }
  CalibrationFigure figure;
  figure.is_known = weights > 0.0 && independent >= 2.0;
  if (!figure.is_known) return figure;
  figure.value = mean;
  figure.deviation = std::sqrt(squares / weights / independent);
  return figure;
}

CalibrationFigure offsetOf(const ComparedTracks& tracks, const Poses& corrected, double independent) {
  constexpr double kAround = 0.03;  // [s] over which the cost is a parabola
  const auto cost = [&](double offset) {
    const double harm = tracks.meanHarm(tracks.shifted(corrected, offset));
    return harm * harm;
  };
  CalibrationFigure figure;
  figure.value = tracks.timeOffset(corrected);
  const double least = cost(figure.value);
  const double curvature =
      (cost(figure.value - kAround) - 2.0 * least + cost(figure.value + kAround)) / (kAround * kAround);
  if (!(curvature > 0.0) || independent < 2.0) return figure;
  figure.deviation = std::max(0.005, std::sqrt(2.0 * least / curvature / independent));
  // What a shift of 0.1 s changes has to be more than the noise of a sound odometry.
  const double change = cost(figure.value + 0.1) - least;
  figure.is_known = figure.deviation < kSureOffset && std::abs(figure.value) < kMostOffset && change > 0.1;
  return figure;
}

}  // namespace

OdometryCalibration calibrate(const std::deque<ComparedScan>& scans, const ComparisonWindow& window) {
  OdometryCalibration calibration;
  const ComparedTracks tracks(scans, window);
  if (tracks.windows() == 0) return calibration;
  const double independent = static_cast<double>(scans.size()) / static_cast<double>(window.scans);
  const double yaw = tracks.mountingYaw(tracks.given()), scale = tracks.scale(tracks.given());
  if (tracks.way() >= kLeastWay && scale > 0.0) {
    const auto motions = tracks.motions(tracks.given());
    calibration.yaw = figureOf(motions, yaw, independent, [](const ComparedTracks::Motions& m) {
      return std::atan2(m.found.x() * m.given.y() - m.found.y() * m.given.x(), m.found.dot(m.given));
    });
    calibration.scale = figureOf(motions, scale, independent, [](const ComparedTracks::Motions& m) {
      return m.given.norm() / std::max(m.found.norm(), 1e-9);
    });
    const Poses corrected = turned(scaled(tracks.given(), 1.0 / scale), yaw);
    calibration.time_offset = offsetOf(tracks, corrected, independent);
  }
  return calibration;
}

std::vector<std::string> describe(const OdometryCalibration& calibration, const Eigen::Isometry3d& base_from_sensor,
                                  const std::string& base_frame, const std::string& sensor_frame) {
  std::vector<std::string> lines;
  if (calibration.yaw.is_known) {
    const double yaw = calibration.yaw.value;
    lines.push_back(
        textOf("mounting: the sensor is turned by %+.2f degrees (to the left) against what is believed, +- %.2f",
               yaw * kDegrees, calibration.yaw.deviation * kDegrees));
    const Eigen::Matrix3d mended =
        Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix() * base_from_sensor.linear();
    const Eigen::Vector3d place = base_from_sensor.translation();
    lines.push_back(textOf("  mended by: static_transform_publisher %.3f %.3f %.3f %.5f %.5f %.5f %s %s", place.x(),
                           place.y(), place.z(), std::atan2(mended(1, 0), mended(0, 0)),
                           std::asin(std::clamp(-mended(2, 0), -1.0, 1.0)), std::atan2(mended(2, 1), mended(2, 2)),
                           base_frame.c_str(), sensor_frame.c_str()));
  } else {
    lines.emplace_back("mounting: not told by this drive, which needs 10 m of way");
  }
  lines.push_back(calibration.scale.is_known
                      ? textOf("scale: the odometry's lengths are %.4f times the true ones, +- %.4f",
                               calibration.scale.value, calibration.scale.deviation)
                      : "scale: not told by this drive, which needs 10 m of way");
  lines.push_back(calibration.time_offset.is_known
                      ? textOf("stamps: the odometry's are %+.3f s late, +- %.3f", calibration.time_offset.value,
                               calibration.time_offset.deviation)
                      : "stamps: not told by this drive, which needs turns or changes of speed");
  return lines;
}

}  // namespace donex
