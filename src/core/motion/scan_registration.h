// A scan against a map of Gaussians: point to plane, with weights that leave out what does not fit.
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "core/motion/gaussian_map.h"

namespace donex {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

struct RegistrationOptions {
  int most_steps = 30;  ///< Gauss-Newton steps
  /// Distances beyond weigh little (Geman-McClure), at the end [m]: some times the noise of a range.
  double kernel = 0.12;
  double kernel_shrink = 0.6;      ///< of the kernel from step to step, from the gate to `kernel`
  double surface_noise = 0.03;     ///< a surface as thick as this weighs half [m]
  double done_translation = 2e-4;  ///< a smaller step is the last [m]
  double done_rotation = 1e-5;     ///< a smaller step is the last [rad]
  double inlier_distance = 0.3;    ///< an echo nearer to its surface fits [m]
  /// Information a used echo gives on a direction (0: none, 1/3: on all alike) below which that is undetermined.
  double least_information = 0.008;
  /// x, y and yaw are found, too; else the prediction stands in them, and height, roll and pitch alone are found.
  bool along_ground = true;
  /// fitness() counts echoes on the ground. It fits wherever the vehicle is, and best where its rings lie as before.
  bool counts_ground = true;
  double longest_arm = 5.0;  ///< turns are compared with translations by the way of an echo at most this far away [m]
};

struct Registration {
  Eigen::Isometry3d map_from_sensor = Eigen::Isometry3d::Identity();
  std::size_t matched = 0;         ///< echoes in voxels with a surface
  std::size_t fitting = 0;         ///< of these, near it
  double least_information = 0.0;  ///< on the least determined direction
  int undetermined = 0;            ///< directions that the scan does not determine; there the prediction stands
  Eigen::Vector3d weakest = Eigen::Vector3d::UnitX();  ///< the translation that is determined least
  bool converged = false;
};

/// Registers one scan after the other. Echoes in the sensor frame [m].
class ScanRegistration {
 public:
  explicit ScanRegistration(const RegistrationOptions& options) : options_(options) {}

  /// From `prediction`, which may be off by `gate` [m].
  Registration align(GaussianMap& map, const std::vector<Eigen::Vector3f>& echoes, const Eigen::Isometry3d& prediction,
                     double gate) const;

  /// How well the echoes fit at `pose`: the mean weight of an echo, 0 to 1, with a kernel of `kernel` [m].
  double fitness(GaussianMap& map, const std::vector<Eigen::Vector3f>& echoes, const Eigen::Isometry3d& pose,
                 double kernel, std::size_t stride) const;

 private:
  struct NormalEquations {
    Matrix6d information = Matrix6d::Zero();
    Vector6d gradient = Vector6d::Zero();
    double weight = 0.0;
    double squared_range = 0.0;  // weighted
    std::size_t matched = 0, fitting = 0;
  };

  void leaveOutGround(NormalEquations& equations) const;
  NormalEquations linearise(GaussianMap& map, const std::vector<Eigen::Vector3f>& echoes, const Eigen::Isometry3d& pose,
                            double kernel) const;
  Vector6d solve(const NormalEquations& equations, const Eigen::Isometry3d& pose, const Eigen::Isometry3d& prediction,
                 Registration& result) const;

  RegistrationOptions options_;
};

}  // namespace donex
