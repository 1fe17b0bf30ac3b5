#include "core/motion/odometry_correction.h"

#include <algorithm>
#include <cmath>

#include "donex/motion/rigid_motion.h"

namespace donex {
namespace {

constexpr double kJump = 0.25;         // [m] in one scan that no odometry has for a fault of its scale or mounting
constexpr double kFrozenShare = 0.02;  // of the true way; less is no motion
constexpr double kMoving = 0.05;       // [m] a scan; less may be standing still
constexpr double kSeldom = 0.1;        // share of scans; jumps that are more frequent have another cause

Eigen::Matrix3d turnsAs(const Eigen::Matrix3d& rotation, double sign) {
  if (sign > 0.0) return rotation;
  const Eigen::Vector3d mirror(1.0, -1.0, 1.0);
  return mirror.asDiagonal() * rotation * mirror.asDiagonal();
}

Eigen::Matrix2d axes(double xx, double xy, double yx, double yy) {
  Eigen::Matrix2d matrix;
  matrix << xx, xy, yx, yy;
  return matrix;
}

}  // namespace

const std::vector<AxisFault>& axisFaults() {
  static const std::vector<AxisFault> faults{
      {"x of the position has the wrong sign", axes(-1, 0, 0, 1), 1.0},
      {"y of the position has the wrong sign", axes(1, 0, 0, -1), 1.0},
      {"x and y of the position have the wrong sign", axes(-1, 0, 0, -1), 1.0},
      {"x and y of the position are swapped", axes(0, 1, 1, 0), 1.0},
      {"yaw has the wrong sign", axes(1, 0, 0, 1), -1.0},
      {"y and yaw have the wrong sign", axes(1, 0, 0, -1), -1.0},
      {"x and yaw have the wrong sign", axes(-1, 0, 0, 1), -1.0},
      {"x and y are swapped, and yaw has the wrong sign", axes(0, 1, 1, 0), -1.0}};
  return faults;
}

Poses withAxes(const Poses& given, const AxisFault& fault) {
  Poses corrected = given;
  for (Eigen::Isometry3d& pose : corrected) {
    pose.translation().head<2>() = fault.position * Eigen::Vector2d(pose.translation().head<2>());
    pose.linear() = turnsAs(pose.linear(), fault.turn_sign);
  }
  return corrected;
}

Poses turned(const Poses& given, double yaw) {
  Poses corrected = given;
  for (Eigen::Isometry3d& pose : corrected) pose.rotate(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
  return corrected;
}

Poses scaled(const Poses& given, double factor) {
  Poses corrected = given;
  for (Eigen::Isometry3d& pose : corrected) pose.translation() *= factor;
  return corrected;
}

Poses fromWorldTwist(const Poses& given) {
  Poses corrected = given;
  for (std::size_t i = 1; i < given.size(); ++i) {
    const Eigen::Vector3d step = given[i].translation() - given[i - 1].translation();
    corrected[i].translation() = corrected[i - 1].translation() + given[i - 1].linear().transpose() * step;
  }
  return corrected;
}

ComparedTracks::ComparedTracks(const std::deque<ComparedScan>& scans, const ComparisonWindow& window) {
  for (const ComparedScan& scan : scans) {
    stamps_.push_back(scan.stamp);
    given_.push_back(scan.given);
    found_.push_back(scan.found);
  }
  for (std::size_t last = 0; last < found_.size(); ++last) {
    Window span{0, last};
    if (windowBefore(found_, last, window, span.first)) windows_.push_back(span);
  }
}

double ComparedTracks::way() const {
  double way = 0.0;
  for (std::size_t i = 1; i < found_.size(); ++i) {
    way += (found_[i].translation() - found_[i - 1].translation()).norm();
  }
  return way;
}

double ComparedTracks::meanHarm(const Poses& corrected) const {
  double sum = 0.0;
  for (const Window& span : windows_) sum += differenceBetween(corrected, found_, span.first, span.last).harm();
  return windows_.empty() ? 0.0 : sum / static_cast<double>(windows_.size());
}

std::vector<ComparedTracks::Motions> ComparedTracks::motions(const Poses& given) const {
  std::vector<Motions> motions;
  for (const Window& span : windows_) {
    motions.push_back({(given[span.first].inverse() * given[span.last]).translation().head<2>(),
                       (found_[span.first].inverse() * found_[span.last]).translation().head<2>()});
  }
  return motions;
}

/// The scans' motion in the vehicle's axes goes through the mounting: turned too far, it is turned as far.
double ComparedTracks::mountingYaw(const Poses& given) const {
  double cross = 0.0, dot = 0.0;
  for (const Motions& motion : motions(given)) {
    cross += motion.found.x() * motion.given.y() - motion.found.y() * motion.given.x();
    dot += motion.found.dot(motion.given);
  }
  return std::atan2(cross, dot);
}

double ComparedTracks::scale(const Poses& given) const {
  double both = 0.0, found = 0.0;
  for (const Motions& motion : motions(given)) {
    both += motion.found.norm() * motion.given.norm();
    found += motion.found.squaredNorm();
  }
  return found > 0.0 ? both / found : 1.0;
}

double ComparedTracks::timeOffset(const Poses& given) const {
  constexpr double kMost = 0.3, kStep = 0.01;  // [s]
  double best = 0.0, least = meanHarm(given);
  for (double offset = -kMost; offset <= kMost + 0.5 * kStep; offset += kStep) {
    const double harm = meanHarm(shifted(given, offset));
    if (harm >= least) continue;
    least = harm;
    best = offset;
  }
  return best;
}

Poses ComparedTracks::shifted(const Poses& given, double offset) const {
  if (given.size() < 2) return given;
  Poses result = given;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const double stamp = stamps_[i] + offset;
    const auto after = std::upper_bound(stamps_.begin() + 1, stamps_.end() - 1, stamp);
    const auto next = static_cast<std::size_t>(after - stamps_.begin());  // beyond the ends the motion goes on
    const double share = (stamp - stamps_[next - 1]) / (stamps_[next] - stamps_[next - 1]);
    result[i] = interpolate(given[next - 1], given[next], share);
  }
  return result;
}

double ComparedTracks::stepDifference(std::size_t scan) const {
  return differenceBetween(given_, found_, scan - 1, scan).distance;
}

bool ComparedTracks::isFrozen(std::size_t scan) const {
  const double given = (given_[scan].translation() - given_[scan - 1].translation()).norm();
  const double found = (found_[scan].translation() - found_[scan - 1].translation()).norm();
  return found > kMoving && given < kFrozenShare * found;
}

Repair ComparedTracks::replaced(const std::vector<bool>& is_wrong) const {
  Repair repair;
  repair.poses = given_;
  for (std::size_t i = 1; i < given_.size(); ++i) {
    const Poses& source = is_wrong[i] ? found_ : given_;
    repair.poses[i] = repair.poses[i - 1] * (source[i - 1].inverse() * source[i]);
    if (!is_wrong[i]) continue;
    ++repair.scans;
    repair.size = std::max(repair.size, stepDifference(i));
  }
  return repair;
}

Repair ComparedTracks::withoutJumps() const {
  std::vector<bool> is_jump(given_.size(), false);
  std::size_t jumps = 0;
  for (std::size_t i = 1; i < given_.size(); ++i) {
    is_jump[i] = stepDifference(i) > kJump;
    jumps += is_jump[i] ? 1U : 0U;
  }
  const bool are_seldom = static_cast<double>(jumps) <= std::max(1.0, kSeldom * static_cast<double>(given_.size()));
  return are_seldom ? replaced(is_jump) : Repair();
}

/// With the step after, in which the odometry may make up for all.
Repair ComparedTracks::withoutFrozen() const {
  std::vector<bool> is_wrong(given_.size(), false);
  std::size_t frozen = 0;
  for (std::size_t i = 1; i < given_.size(); ++i) {
    const bool stands = isFrozen(i);
    const bool makes_up = i > 1 && isFrozen(i - 1) && stepDifference(i) > kJump;
    is_wrong[i] = stands || makes_up;
    frozen += stands ? 1U : 0U;
  }
  if (frozen < 2) return {};
  Repair repair = replaced(is_wrong);
  repair.scans = frozen;
  return repair;
}

}  // namespace donex
