#include "donex/motion/deskew.h"

#include <algorithm>
#include <cmath>

namespace donex {
namespace {

/// Poses are looked up this often [s] and blended linearly between: at 1 rad/s and 100 m that is off by 3 um.
constexpr double kKnotStep = 0.0005;

/// An affine map by its columns, each in one register: the last entry of all is not used.
struct Columns {
  explicit Columns(const Eigen::Isometry3d& transform) {
    const Eigen::Matrix4f matrix = transform.matrix().cast<float>();
    x = matrix.col(0);
    y = matrix.col(1);
    z = matrix.col(2);
    offset = matrix.col(3);
  }
  Eigen::Array4f apply(const Eigen::Vector3f& v, float weight) const {
    return (weight * x * v.x() + weight * y * v.y()) + (weight * z * v.z() + weight * offset);
  }

  Eigen::Array4f x, y, z, offset;
};

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
    const auto intervals = std::max(1, static_cast<int>(std::ceil((span.last - span.first) / kKnotStep)));
    first_ = span.first;
    step_ = (span.last - span.first) / intervals;
    for (int knot = 0; knot <= intervals; ++knot) {
      const auto pose = knot < intervals ? motion.poseAt(stamp + first_ + knot * step_) : at_last;
      if (!pose) return pose.fault();
      knots_.emplace_back(sensor_from_odom * *pose * mounting);
    }
    last_interval_ = static_cast<int>(knots_.size()) - 2;
    return MotionFault::kNone;
  }

  Eigen::Vector3f move(const Eigen::Vector3f& echo, float time) const {
    const double position = step_ > 0.0 ? (static_cast<double>(time) - first_) / step_ : 0.0;
    const int knot = std::min(static_cast<int>(position), last_interval_);
    const auto weight = static_cast<float>(position - static_cast<double>(knot));
    const Columns* before = knots_.data() + knot;
    const Eigen::Array4f moved = before[0].apply(echo, 1.0F - weight) + before[1].apply(echo, weight);
    return moved.head<3>();
  }

 private:
  double first_ = 0.0, step_ = 0.0;  // [s]
  std::vector<Columns> knots_;       // at least two
  int last_interval_ = 0;
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
