// Rigid motion in six degrees of freedom: the paper's integration of velocities, interpolation, checked input.
#pragma once

#include <utility>
#include <variant>

#include <Eigen/Geometry>

namespace donex {

/// Why a motion cannot be told.
enum class MotionFault {
  kNone,
  kNoSamples,          ///< no odometry at all yet
  kTooOld,             ///< before the oldest odometry kept
  kNotYetCovered,      ///< further beyond the newest odometry than may be extrapolated
  kGapTooLong,         ///< the odometry samples on both sides are too far apart
  kNonFinite,          ///< NaN or infinity in the input
  kNonUnitQuaternion,  ///< an invalid rotation
  kSizeMismatch,       ///< the numbers of times and echoes differ
};

/// The fault in words, fit for a log message ("no odometry yet", ...).
const char* describe(MotionFault fault);

/// A value, or the reason why it is missing. Never a stand-in value.
template <class T>
class MotionResult {
 public:
  MotionResult(T value) : content_(std::move(value)) {}
  MotionResult(MotionFault fault) : content_(fault) {}

  bool ok() const { return std::holds_alternative<T>(content_); }
  explicit operator bool() const { return ok(); }

  /// Throws std::bad_variant_access where there is no value.
  const T& value() const { return std::get<T>(content_); }
  const T& operator*() const { return value(); }
  const T* operator->() const { return &value(); }

  MotionFault fault() const { return ok() ? MotionFault::kNone : std::get<MotionFault>(content_); }

 private:
  std::variant<T, MotionFault> content_;
};

/// Velocity of a body in its own frame.
struct Twist {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();   ///< [m/s]
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  ///< [rad/s]
};

/// The motion of a body that keeps `twist` for `duration` [s], which may be negative: coordinates at the end
/// to coordinates at the start (the SE(3) exponential of twist x duration).
Eigen::Isometry3d integrateTwist(const Twist& twist, double duration);

/// Position linear, rotation by slerp; `fraction` 0 is `from`, 1 is `to`, beyond continues the motion.
Eigen::Isometry3d interpolate(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, double fraction);

/// The same pose with its rotation exactly orthonormal again, against drift over long products.
Eigen::Isometry3d orthonormalised(const Eigen::Isometry3d& pose);

/// A pose from numbers that came from outside. A quaternion whose norm is off by rounding is normalised;
/// one further than 1 % from unit length is refused (all zero: an orientation nobody filled in).
MotionResult<Eigen::Isometry3d> checkedPose(const Eigen::Vector3d& position, const Eigen::Quaterniond& rotation);

}  // namespace donex
