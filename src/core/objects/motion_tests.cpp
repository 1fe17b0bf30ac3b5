#include "core/objects/motion_tests.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace donex {
namespace {

constexpr std::size_t kPresentPoints = 4 * Trace::kMostPoints;

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
    : scan_(scan),
      options_(options),
      now_(now),
      points_from_odom_(scan.odom_from_points.inverse()),
      rows_beside_(static_cast<int>(std::ceil(0.5 * scan.beams_apart / static_cast<double>(SightPixels::kRowHeight)))) {
}

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
  const double shift = (segment.center() - trace.center()).head<2>().norm();
  const bool worth_asking =
      !SegmentRules::isMostlySettled(segment) && trace.size() >= options_.least_points && shift >= step.shift;
  return worth_asking && hasLeft(trace, step.margin) && fitsElsewhere(trace, segment, step.shift);
}

bool MotionTests::isDisplaced(const Trace& trace, const Segment& segment, bool world_is_placed) const {
  const MotionTestOptions::Displacement& rule = options_.displacement;
  const bool is_described = segment.echoes.size() >= rule.least_echoes && trace.size() >= rule.least_points;
  const bool is_flat = segment.extent().z() < rule.flat * segment.extent().head<2>().maxCoeff();
  if (!is_described || is_flat) return false;
  const Eigen::Vector2d low = (segment.low - trace.low).head<2>(), high = (segment.high - trace.high).head<2>();
  const double shift = 0.5 * (low + high).norm();
  const double least = (world_is_placed ? rule.least : rule.least_unknown) + seemsShifted(trace, segment);
  const bool is_rigid = (low - high).norm() <= std::max(rule.ends_noise, rule.ends_differ * shift);
  if (!is_rigid || shift < rule.least || shift > rule.most) return false;
  const Formers formers = formersOf(trace);
  const double telling = rule.telling_share * static_cast<double>(trace.size());
  if (static_cast<double>(formers.count - formers.on_surface) < telling) return false;
  // Where one end frays or is hidden, the other one tells how far it went.
  Fits best;
  for (const Eigen::Vector2d& by : {low, high, Eigen::Vector2d(0.5 * (low + high)), Eigen::Vector2d(low.x(), high.y()),
                                    Eigen::Vector2d(high.x(), low.y())}) {
    const Fits fits = fitsAlone(formers, by);
    if (fits.there - fits.here > best.there - best.here) best = fits;
  }
  return best.shift >= least && best.there >= telling && best.here <= rule.contrary_share * best.there;
}

/// What something round that stands seems to shift by as another side of it comes into view [m].
double MotionTests::seemsShifted(const Trace& trace, const Segment& segment) const {
  const Eigen::Vector3d sensor = scan_.odom_from_points * scan_.sensor.cast<double>();
  const Eigen::Vector2d then = (trace.center() - trace.seen_from).head<2>();
  const Eigen::Vector2d now = (segment.center() - sensor).head<2>();
  const double turn = std::abs(std::atan2(then.x() * now.y() - then.y() * now.x(), then.dot(now)));
  return turn * std::min(options_.displacement.round, 0.5 * segment.extent().head<2>().maxCoeff());
}

MotionTests::Formers MotionTests::formersOf(const Trace& trace) const {
  Formers formers;
  for (const Eigen::Vector3d& in_odom : trace) {
    const Eigen::Vector3f point = (points_from_odom_ * in_odom).cast<float>();
    const SightImage::Sight sight = sightOf(point, options_.displacement.surface);
    if (sight == SightImage::Sight::kUnknown) continue;
    formers.all[formers.count++] = {point, sight};
    formers.on_surface += sight == SightImage::Sight::kSurface ? 1 : 0;
  }
  return formers;
}

MotionTests::Fits MotionTests::fitsAlone(const Formers& formers, const Eigen::Vector2d& shift) const {
  const double surface = options_.displacement.surface;
  const Eigen::Vector3f by = (points_from_odom_.linear() * Eigen::Vector3d(shift.x(), shift.y(), 0.0)).cast<float>();
  Fits fits;
  fits.shift = shift.norm();
  for (std::size_t i = 0; i < formers.count; ++i) {
    const Former& here = formers.all[i];
    const SightImage::Sight at_there = sightOf(here.point + by, surface);
    if (at_there == SightImage::Sight::kUnknown) continue;
    const bool fits_there = at_there == SightImage::Sight::kSurface;
    if (here.sight == SightImage::Sight::kSurface) {
      fits.here += fits_there ? 0 : 1;
    } else if (fits_there) {
      // What hides the point may be the object itself, come nearer; anything else says nothing.
      const bool tells = here.sight == SightImage::Sight::kFree ||
                         sightOf(here.point, fits.shift + surface) == SightImage::Sight::kSurface;
      fits.there += tells ? 1 : 0;
    }
  }
  return fits;
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
  Eigen::Vector3d shift = segment.center() - trace.center();
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
