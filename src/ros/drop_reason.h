// What can happen to a message other than being used: counted, named in the diagnostics.
#pragma once

#include <array>
#include <cstddef>

namespace donex {

/// Why a cloud was not labelled.
enum class DropReason {
  kBadLayout,       ///< the cloud cannot be read
  kQueueFull,       ///< newer clouds were waiting: the oldest goes
  kNoOdometry,      ///< no odometry covered its stamp in time
  kBeforeOdometry,  ///< older than the oldest odometry
  kOdometryGap,     ///< odometry is missing around its stamp
  kNoTransform,     ///< tf does not connect its frame with the vehicle's
  kOutOfOrder,      ///< older than a labelled cloud of the same sensor, or far behind those of others
  kDuplicate,       ///< the same cloud again: frame, stamp and content
  kTimeRanBack,     ///< waiting when time ran back
  kInternalError,   ///< an exception
  kLost,            ///< the ego motion was to be found in the clouds, and this one does not tell it
};
constexpr std::size_t kDropReasons = 11;

/// In words, fit for a log line and a key of the diagnostics.
const char* describe(DropReason reason);

/// Why an odometry message was not used.
enum class OdometryRefusal {
  kNonFinite,
  kNonUnitQuaternion,
  kDuplicate,
  kTooOld,
  kNoFrame,
  kStandsStill,  ///< the pose stays where it is while the twist moves
  kOtherSource,  ///< of other frames than those of the odometry in use
};
constexpr std::size_t kOdometryRefusals = 7;

const char* describe(OdometryRefusal refusal);

/// How often each happened.
template <class Reason, std::size_t kReasons>
class ReasonCounts {
 public:
  void add(Reason reason) { ++counts_[static_cast<std::size_t>(reason)]; }
  std::size_t of(Reason reason) const { return counts_[static_cast<std::size_t>(reason)]; }
  std::size_t total() const {
    std::size_t sum = 0;
    for (const std::size_t count : counts_) sum += count;
    return sum;
  }

 private:
  std::array<std::size_t, kReasons> counts_{};
};

using DropCounts = ReasonCounts<DropReason, kDropReasons>;
using OdometryRefusalCounts = ReasonCounts<OdometryRefusal, kOdometryRefusals>;

}  // namespace donex
