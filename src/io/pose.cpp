#include "io/pose.h"

#include <cmath>

#include <fmt/format.h>

namespace donex {
namespace {

constexpr double kRounding = 1e-3;  // of a rotation matrix: files hold as few as four digits

/// Dividing by the norm may move last bits again and again: of the neighbours of the unit quaternion, a few last
/// bits of its largest coefficient away, the nearest that normalising leaves as it is.
Eigen::Quaterniond stablyNormalised(const Eigen::Quaterniond& q) {
  constexpr int kMostSteps = 32;
  Eigen::Quaterniond unit = q.normalized();
  Eigen::Index largest = 0;
  const double size = unit.coeffs().cwiseAbs().maxCoeff(&largest);
  const double step = std::nextafter(size, 2.0) - size;
  for (int i = 0; i < kMostSteps; ++i) {
    Eigen::Quaterniond candidate = unit;
    candidate.coeffs()[largest] += step * (i % 2 == 0 ? i / 2 : -(i + 1) / 2);
    if (candidate.normalized().coeffs() == candidate.coeffs()) return candidate;
  }
  return unit;
}

}  // namespace

Pose Pose::fromIsometry(const Eigen::Isometry3d& transform) { return poseFromMatrix(transform.matrix().topRows<3>()); }

Eigen::Isometry3d Pose::isometry() const {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = orientation.toRotationMatrix();
  transform.translation() = position;
  return transform;
}

Pose interpolate(const Pose& from, const Pose& to, double fraction) {
  if (fraction == 0.0) return from;
  if (fraction == 1.0) return to;
  return {from.position + fraction * (to.position - from.position),
          stablyNormalised(from.orientation.slerp(fraction, to.orientation))};
}

std::optional<std::string> faultOfPose(const PoseMatrix& matrix) {
  if (!matrix.allFinite()) return "the pose is not finite";
  const Eigen::Matrix3d rotation = matrix.leftCols<3>();
  const double deviation = (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(deviation <= kRounding)) {
    return fmt::format("the pose is not rigid: its rotation part is off orthonormal by {:.3g}", deviation);
  }
  if (rotation.determinant() < 0.0) return "the pose is not rigid: its rotation part mirrors";
  return std::nullopt;
}

Pose poseFromMatrix(const PoseMatrix& matrix) {
  const Eigen::Matrix3d rotation = matrix.leftCols<3>();
  return {matrix.col(3), stablyNormalised(Eigen::Quaterniond(rotation))};
}

std::string poseLine(const Pose& pose) {
  const PoseMatrix m = pose.isometry().matrix().topRows<3>();
  std::string line;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      line += fmt::format("{}{:.17g}", line.empty() ? "" : " ", m(row, column));
    }
  }
  return line + '\n';
}

}  // namespace donex
