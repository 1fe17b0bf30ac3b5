#include "ros/drop_reason.h"

namespace donex {

const char* describe(DropReason reason) {
  switch (reason) {
    case DropReason::kBadLayout: return "unreadable cloud";
    case DropReason::kQueueFull: return "queue full";
    case DropReason::kNoOdometry: return "no odometry in time";
    case DropReason::kBeforeOdometry: return "before the first odometry";
    case DropReason::kOdometryGap: return "gap in the odometry";
    case DropReason::kNoTransform: return "no transform";
    case DropReason::kOutOfOrder: return "out of order";
    case DropReason::kDuplicate: return "duplicate";
    case DropReason::kTimeRanBack: return "time ran back";
    case DropReason::kInternalError: return "internal error";
    case DropReason::kLost: return "ego motion not found";
  }
  return "unknown";
}

const char* describe(OdometryRefusal refusal) {
  switch (refusal) {
    case OdometryRefusal::kNonFinite: return "not finite";
    case OdometryRefusal::kNonUnitQuaternion: return "quaternion not of unit length";
    case OdometryRefusal::kDuplicate: return "duplicate stamp";
    case OdometryRefusal::kTooOld: return "too old";
    case OdometryRefusal::kNoFrame: return "no frame";
    case OdometryRefusal::kStandsStill: return "pose stands still, twist does not";
    case OdometryRefusal::kOtherSource: return "a second source";
  }
  return "unknown";
}

}  // namespace donex
