#include "donex/core/motion_evidence.h"

#include <limits>

namespace donex {
namespace {

constexpr std::size_t kTracePoints = 48;
constexpr std::size_t kLeastPoints = 5;
constexpr int kLeastLeft = 3;        // points of a trace
constexpr double kStillShare = 0.4;  // of the trace may lie near a surface
constexpr double kFit = 0.25;        // [m] between a point and its counterpart
constexpr double kFitShare = 0.6;    // of the trace must have one
constexpr int kFitRounds = 3;
// What many echoes describe is placed better: smaller shifts count.
constexpr std::size_t kManyEchoes = 200;
struct Step {
  double shift;  ///< [m] that the object must have moved
  float margin;  ///< [m] that its former place must be clear by
};
constexpr Step kStep = {0.4, 0.25F}, kStepOfMany = {0.3, 0.2F};

Eigen::Vector3d offsetToNearest(const Eigen::Vector3d& point, const std::vector<Eigen::Vector3d>& others) {
  Eigen::Vector3d nearest = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& other : others) {
    const Eigen::Vector3d offset = other - point;
    const double squared = offset.squaredNorm();
    if (squared < least) least = squared, nearest = offset;
  }
  return nearest;
}

void takePoints(const JudgedScan& scan, const Candidate& candidate, std::size_t at_most,
                std::vector<Eigen::Vector3d>& in_odom) {
  in_odom.clear();
  const std::size_t stride = candidate.echoes.size() / at_most + 1;
  for (std::size_t i = 0; i < candidate.echoes.size(); i += stride) {
    in_odom.push_back(scan.odom_from_points * scan.points[candidate.echoes[i]].cast<double>());
  }
}

}  // namespace

void takeTrace(const JudgedScan& scan, const Candidate& candidate, Trace& trace) {
  trace.stamp = scan.stamp;
  trace.center = candidate.center();
  takePoints(scan, candidate, kTracePoints, trace.in_odom);
}

MotionEvidence::MotionEvidence(const JudgedScan& scan, const SightHistory& history)
    : scan_(scan), history_(history), points_from_odom_(scan.odom_from_points.inverse()) {}

Former MotionEvidence::lookBack(const Trace& trace) const {
  Former former;
  for (const Eigen::Vector3d& point : trace.in_odom) {
    const SightImage::Sight sight = history_.askNewest((points_from_odom_ * point).cast<float>());
    former.left += sight == SightImage::Sight::kFree ? 1 : 0;
    former.still += sight == SightImage::Sight::kSurface ? 1 : 0;
  }
  return former;
}

bool MotionEvidence::hasMoved(const Trace& trace, const Candidate& candidate) const {
  const Step& step = candidate.echoes.size() >= kManyEchoes ? kStepOfMany : kStep;
  const double shift = (candidate.center() - trace.center).head<2>().norm();
  const bool worth_asking = !isMostlySettled(candidate) && trace.in_odom.size() >= kLeastPoints && shift >= step.shift;
  return worth_asking && hasLeft(trace, step.margin) && fitsElsewhere(trace, candidate, step.shift);
}

bool MotionEvidence::hasLeft(const Trace& trace, float margin) const {
  int left = 0, still = 0, near_surface = 0;
  for (const Eigen::Vector3d& in_odom : trace.in_odom) {
    const Eigen::Vector3f point = (points_from_odom_ * in_odom).cast<float>();
    const SightImage::Sight through = history_.askThroughGaps(point, margin);
    left += through == SightImage::Sight::kFree ? 1 : 0;
    still += through == SightImage::Sight::kSurface ? 1 : 0;
    near_surface += history_.askNewest(point, margin) == SightImage::Sight::kSurface ? 1 : 0;
  }
  return left >= kLeastLeft && left > still && near_surface <= kStillShare * static_cast<double>(trace.in_odom.size());
}

bool MotionEvidence::fitsElsewhere(const Trace& trace, const Candidate& candidate, double least_shift) const {
  std::vector<Eigen::Vector3d> present;
  takePoints(scan_, candidate, 4 * kTracePoints, present);
  // From centre to centre, which another view of the same thing displaces, to the best fit.
  Eigen::Vector3d shift = candidate.center() - trace.center;
  int fitting = 0;
  for (int round = 1; round <= kFitRounds; ++round) {
    const double reach = round < kFitRounds ? 2.0 * kFit : kFit;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    fitting = 0;
    for (const Eigen::Vector3d& point : trace.in_odom) {
      const Eigen::Vector3d offset = offsetToNearest(point + shift, present);
      if (offset.norm() < reach) sum += offset, ++fitting;
    }
    if (fitting == 0) return false;
    if (round < kFitRounds) shift += sum / fitting;
  }
  return shift.head<2>().norm() >= least_shift && fitting >= kFitShare * static_cast<double>(trace.in_odom.size());
}

}  // namespace donex
