#include "core/objects/motion_tests.h"

#include <array>
#include <limits>

namespace donex {
namespace {

constexpr std::size_t kPresentPoints = 4 * TraceHistory::kPoints;

/// Some echoes of a segment.
struct Points {
  std::array<Eigen::Vector3d, kPresentPoints> in_odom;
  std::size_t count = 0;
};

Eigen::Vector3d offsetToNearest(const Eigen::Vector3d& point, const Points& others) {
  Eigen::Vector3d nearest = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < others.count; ++i) {
    const Eigen::Vector3d offset = others.in_odom[i] - point;
    const double squared = offset.squaredNorm();
    if (squared < least) least = squared, nearest = offset;
  }
  return nearest;
}

}  // namespace

MotionTests::MotionTests(const JudgedScan& scan, const ScanSight& now, const MotionTestOptions& options)
    : scan_(scan), options_(options), now_(now), points_from_odom_(scan.odom_from_points.inverse()) {}

FormerPlace MotionTests::lookBack(const Trace& trace) const {
  FormerPlace former;
  for (const Eigen::Vector3d& point : trace) {
    const SightImage::Sight sight = now_.at((points_from_odom_ * point).cast<float>());
    former.left += sight == SightImage::Sight::kFree ? 1 : 0;
    former.still += sight == SightImage::Sight::kSurface ? 1 : 0;
  }
  return former;
}

bool MotionTests::hasMoved(const Trace& trace, const Segment& segment) const {
  const bool is_placed_well = segment.echoes.size() >= options_.many_echoes;
  const MotionTestOptions::Step& step = is_placed_well ? options_.step_of_many : options_.step;
  const double shift = (segment.center() - trace.center).head<2>().norm();
  const bool worth_asking =
      !SegmentRules::isMostlySettled(segment) && trace.size() >= options_.least_points && shift >= step.shift;
  return worth_asking && hasLeft(trace, step.margin) && fitsElsewhere(trace, segment, step.shift);
}

bool MotionTests::hangs(const Segment& segment) const {
  if (segment.lowest <= static_cast<float>(options_.stands_below)) return false;
  int seen = 0, hidden = 0;
  const std::size_t stride = segment.echoes.size() / options_.points_beneath + 1;
  for (std::size_t i = 0; i < segment.echoes.size(); i += stride) {
    const std::uint32_t echo = segment.echoes[i];
    Eigen::Vector3f beneath = scan_.points[echo];
    beneath.z() -= scan_.heights[echo] - 0.5F * segment.lowest;
    const SightImage::Sight sight = now_.throughGaps(beneath, static_cast<float>(options_.beneath_margin));
    seen += sight == SightImage::Sight::kFree || sight == SightImage::Sight::kSurface ? 1 : 0;
    hidden += sight == SightImage::Sight::kHidden ? 1 : 0;
  }
  return seen > hidden;
}

bool MotionTests::hasLeft(const Trace& trace, double margin) const {
  const auto clear_by = static_cast<float>(margin);
  int left = 0, still = 0, near_surface = 0;
  for (const Eigen::Vector3d& in_odom : trace) {
    const Eigen::Vector3f point = (points_from_odom_ * in_odom).cast<float>();
    const SightImage::Sight through = now_.throughGaps(point, clear_by);
    left += through == SightImage::Sight::kFree ? 1 : 0;
    still += through == SightImage::Sight::kSurface ? 1 : 0;
    near_surface += now_.at(point, clear_by) == SightImage::Sight::kSurface ? 1 : 0;
  }
  return left >= options_.least_left && left > still &&
         near_surface <= options_.still_share * static_cast<double>(trace.size());
}

bool MotionTests::fitsElsewhere(const Trace& trace, const Segment& segment, double least_shift) const {
  Points present;
  visitSome(scan_, segment, kPresentPoints,
            [&](const Eigen::Vector3d& point) { present.in_odom[present.count++] = point; });
  // From centre to centre, which another view of the same object displaces, to the best fit.
  Eigen::Vector3d shift = segment.center() - trace.center;
  int fitting = 0;
  for (int round = 1; round <= options_.fit_rounds; ++round) {
    const double reach = round < options_.fit_rounds ? 2.0 * options_.fit_distance : options_.fit_distance;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    fitting = 0;
    for (const Eigen::Vector3d& point : trace) {
      const Eigen::Vector3d offset = offsetToNearest(point + shift, present);
      if (offset.norm() < reach) sum += offset, ++fitting;
    }
    if (fitting == 0) return false;
    if (round < options_.fit_rounds) shift += sum / fitting;
  }
  return shift.head<2>().norm() >= least_shift && fitting >= options_.fit_share * static_cast<double>(trace.size());
}

}  // namespace donex
