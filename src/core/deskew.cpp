#include "donex/core/deskew.h"

#include <algorithm>
#include <cmath>

namespace donex {
namespace {

/// Poses are looked up this often [s] and blended linearly between: at 1 rad/s and 100 m that is off by 3 um.
constexpr double kKnotStep = 0.0005;

using Rows = Eigen::Matrix<float, 3, 4>;

struct TimeSpan {
  double first = 0.0, last = 0.0;  // relative to the stamp [s]
};

/// The span of the finite echoes' times; {0, 0} without any.
MotionResult<TimeSpan> spanOf(const std::vector<float>& times, const std::vector<Eigen::Vector3f>& echoes) {
  TimeSpan span;
  bool any = false;
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    if (!echoes[i].allFinite()) continue;
    const auto time = static_cast<double>(times[i]);
    if (!std::isfinite(time)) return MotionFault::kNonFinite;
    span.first = any ? std::min(span.first, time) : time;
    span.last = any ? std::max(span.last, time) : time;
    any = true;
  }
  return span;
}

/// The sensor's motion within one scan, as transforms into the sensor frame at the stamp, evenly spaced in time.
class MotionTable {
 public:
  MotionFault fill(const EgoMotion& motion, double stamp, const TimeSpan& span, const Eigen::Isometry3d& mounting) {
    const auto at_stamp = motion.poseAt(stamp);
    const auto at_first = motion.poseAt(stamp + span.first);
    const auto at_last = motion.poseAt(stamp + span.last);
    // The ends first: nonsensical times must not size the table.
    for (const auto* pose : {&at_stamp, &at_first, &at_last}) {
      if (!pose->ok()) return pose->fault();
    }
    const Eigen::Isometry3d sensor_from_odom = (*at_stamp * mounting).inverse();
    const double intervals = std::max(1.0, std::ceil((span.last - span.first) / kKnotStep));
    first_ = span.first;
    step_ = (span.last - span.first) / intervals;
    for (double knot = 0.0; knot <= intervals; ++knot) {
      const auto pose = knot < intervals ? motion.poseAt(stamp + first_ + knot * step_) : at_last;
      if (!pose) return pose.fault();
      knots_.push_back((sensor_from_odom * *pose * mounting).matrix().topRows<3>().cast<float>());
    }
    return MotionFault::kNone;
  }

  Eigen::Vector3f move(const Eigen::Vector3f& echo, float time) const {
    const double position = step_ > 0.0 ? (static_cast<double>(time) - first_) / step_ : 0.0;
    const auto knot = std::min(static_cast<std::size_t>(position), knots_.size() - 2);
    const auto weight = static_cast<float>(position - static_cast<double>(knot));
    const Eigen::Vector4f homogeneous = echo.homogeneous();
    return (1.0F - weight) * (knots_[knot] * homogeneous) + weight * (knots_[knot + 1] * homogeneous);
  }

 private:
  double first_ = 0.0, step_ = 0.0;  // [s]
  std::vector<Rows> knots_;          // at least two
};

}  // namespace

MotionFault deskew(const EgoMotion& motion, double stamp, const Eigen::Isometry3d& base_from_sensor,
                   const std::vector<float>& times, std::vector<Eigen::Vector3f>& echoes) {
  if (times.size() != echoes.size()) return MotionFault::kSizeMismatch;
  const auto span = spanOf(times, echoes);
  if (!span) return span.fault();
  MotionTable table;
  const MotionFault fault = table.fill(motion, stamp, *span, base_from_sensor);
  if (fault != MotionFault::kNone) return fault;
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    if (echoes[i].allFinite()) echoes[i] = table.move(echoes[i], times[i]);
  }
  return MotionFault::kNone;
}

}  // namespace donex
