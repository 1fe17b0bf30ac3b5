#include "core/motion/scan_registration.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "core/motion/rotation_vector.h"

namespace donex {
namespace {

/// Geman-McClure: 1 at no distance, 1/4 at the kernel, nothing far away.
double weightOf(double squared_distance, double squared_kernel) {
  const double share = squared_kernel / (squared_kernel + squared_distance);
  return share * share;
}

/// The motion around the sensor's own place that leads from `pose` to `target`.
Vector6d difference(const Eigen::Isometry3d& pose, const Eigen::Isometry3d& target) {
  Vector6d motion;
  motion << target.translation() - pose.translation(), rotationVectorOf(target.linear() * pose.linear().transpose());
  return motion;
}

void apply(const Vector6d& motion, Eigen::Isometry3d& pose) {
  pose.linear() = rotationBy(motion.tail<3>()) * pose.linear();
  pose.translation() += motion.head<3>();
}

}  // namespace

ScanRegistration::NormalEquations ScanRegistration::linearise(GaussianMap& map,
                                                              const std::vector<Eigen::Vector3f>& echoes,
                                                              const Eigen::Isometry3d& pose, double kernel) const {
  NormalEquations sums;
  const double squared_kernel = kernel * kernel;
  const double noise = options_.surface_noise * options_.surface_noise;
  const double inlier = options_.inlier_distance * options_.inlier_distance;
  for (const Eigen::Vector3f& echo : echoes) {
    const Eigen::Vector3d arm = pose.linear() * echo.cast<double>();
    const Eigen::Vector3d point = arm + pose.translation();
    const SurfaceMatch match = map.surfaceAt(point);
    if (match.surface == nullptr) continue;
    ++sums.matched;
    const Eigen::Vector3d axis = match.surface->normal.cast<double>();
    const Eigen::Vector3d offset = point - match.mean;
    const double along = axis.dot(offset);
    const double squared = match.is_pole ? offset.squaredNorm() - along * along : along * along;
    if (squared < inlier) ++sums.fitting;
    const double weight =
        weightOf(squared, squared_kernel) * noise / (noise + static_cast<double>(match.surface->variance));
    sums.weight += weight;
    sums.squared_range += weight * arm.squaredNorm();
    const auto addDirection = [&](const Eigen::Vector3d& direction) {
      Vector6d jacobian;
      jacobian << direction, arm.cross(direction);
      sums.information.noalias() += weight * jacobian * jacobian.transpose();
      sums.gradient.noalias() += weight * direction.dot(offset) * jacobian;
    };
    if (match.is_pole) {
      const Eigen::Vector3d across = axis.unitOrthogonal();
      addDirection(across);
      addDirection(axis.cross(across));
    } else {
      addDirection(axis);
    }
  }
  return sums;
}

/// Directions of no information are left to the prediction.
void ScanRegistration::leaveOutGround(NormalEquations& equations) const {
  for (const int direction : {0, 1, 5}) {
    equations.information.row(direction).setZero();
    equations.information.col(direction).setZero();
    equations.gradient[direction] = 0.0;
  }
}

/// Directions are compared in metres: turns by the way of an echo at the usual range, or nearer. Along a
/// corridor most echoes are far away, and those that tell its roll are not.
Vector6d ScanRegistration::solve(const NormalEquations& equations, const Eigen::Isometry3d& pose,
                                 const Eigen::Isometry3d& prediction, Registration& result) const {
  Vector6d scale = Vector6d::Ones();
  const double range = std::sqrt(equations.squared_range / equations.weight);
  scale.tail<3>().setConstant(1.0 / std::min(std::max(range, 1e-3), options_.longest_arm));
  const Matrix6d information = scale.asDiagonal() * equations.information * scale.asDiagonal() / equations.weight;
  const Vector6d gradient = scale.asDiagonal() * equations.gradient / equations.weight;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(information);
  const Vector6d to_prediction = difference(pose, prediction).cwiseQuotient(scale);
  Vector6d step = Vector6d::Zero();
  result.undetermined = 0;
  result.least_information = solver.eigenvalues()[0];
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> translations(information.topLeftCorner<3, 3>());
  result.weakest = translations.eigenvectors().col(0);
  for (int i = 0; i < 6; ++i) {
    const Vector6d direction = solver.eigenvectors().col(i);
    const double value = solver.eigenvalues()[i];
    if (value > options_.least_information) {
      step -= direction * (direction.dot(gradient) / value);
    } else {
      ++result.undetermined;
      step += direction * direction.dot(to_prediction);
    }
  }
  return scale.asDiagonal() * step;
}

Registration ScanRegistration::align(GaussianMap& map, const std::vector<Eigen::Vector3f>& echoes,
                                     const Eigen::Isometry3d& prediction, double gate) const {
  Registration result;
  result.map_from_sensor = prediction;
  double kernel = std::max(gate, options_.kernel);
  for (int i = 0; i < options_.most_steps; ++i) {
    NormalEquations equations = linearise(map, echoes, result.map_from_sensor, kernel);
    result.matched = equations.matched;
    result.fitting = equations.fitting;
    if (equations.matched < 6 || !(equations.weight > 1e-9)) {
      result.undetermined = 6;
      return result;
    }
    if (!options_.along_ground) leaveOutGround(equations);
    const Vector6d step = solve(equations, result.map_from_sensor, prediction, result);
    if (!step.allFinite()) return result;
    apply(step, result.map_from_sensor);
    const bool is_small =
        step.head<3>().norm() < options_.done_translation && step.tail<3>().norm() < options_.done_rotation;
    const bool is_final = kernel <= options_.kernel;
    if (is_small && is_final) {
      result.converged = true;
      break;
    }
    kernel = std::max(options_.kernel, kernel * options_.kernel_shrink);
  }
  return result;
}

double ScanRegistration::fitness(GaussianMap& map, const std::vector<Eigen::Vector3f>& echoes,
                                 const Eigen::Isometry3d& pose, double kernel, std::size_t stride) const {
  constexpr float kLevel = 0.8F;  // of a normal's height: ground
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < echoes.size(); i += stride, ++count) {
    const Eigen::Vector3d point = pose * echoes[i].cast<double>();
    const SurfaceMatch match = map.surfaceAt(point);
    if (match.surface == nullptr) continue;
    const bool is_ground = !match.is_pole && std::abs(match.surface->normal.z()) > kLevel;
    if (is_ground && !options_.counts_ground) continue;
    const Eigen::Vector3d offset = point - match.mean;
    const double along = match.surface->normal.cast<double>().dot(offset);
    const double squared = match.is_pole ? offset.squaredNorm() - along * along : along * along;
    sum += weightOf(squared, kernel * kernel);
  }
  return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

}  // namespace donex
