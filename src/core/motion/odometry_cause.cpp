#include "core/motion/odometry_cause.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <utility>
#include <vector>

#include "core/motion/odometry_correction.h"
#include "core/pi.h"

namespace donex {
namespace {

/// A correction has to leave less than this share of the harm: otherwise the cause is another one.
constexpr double kMended = 0.5;

template <class... Values>
std::string textOf(const char* format, Values... values) {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

/// The search for the correction that leaves least.
class CauseSearch {
 public:
  CauseSearch(const std::deque<ComparedScan>& scans, const ComparisonWindow& window) : tracks_(scans, window) {
    best_.before = best_.remaining = tracks_.meanHarm(tracks_.given());
  }

  void tryJumps() {
    const Repair repair = tracks_.withoutJumps();
    if (repair.scans > 0) attempt(OdometryCause::kJump, repair.size, "", repair.poses);
  }
  void tryFrozen() {
    const Repair repair = tracks_.withoutFrozen();
    if (repair.scans > 0) attempt(OdometryCause::kFrozen, static_cast<double>(repair.scans), "", repair.poses);
  }
  void tryMounting() {
    const double yaw = tracks_.mountingYaw(tracks_.given());
    attempt(OdometryCause::kMountingYaw, yaw, "", turned(tracks_.given(), yaw));
  }
  void tryScale() {
    const double scale = tracks_.scale(tracks_.given());
    const bool is_plausible = scale > 0.1 && scale < 10.0;
    if (is_plausible) attempt(OdometryCause::kScale, scale, "", scaled(tracks_.given(), 1.0 / scale));
  }
  void tryTimeOffset() {
    const double offset = tracks_.timeOffset(tracks_.given());
    attempt(OdometryCause::kTimeOffset, offset, "", tracks_.shifted(tracks_.given(), offset));
  }
  void tryAxes() {
    for (const AxisFault& fault : axisFaults()) {
      attempt(OdometryCause::kAxes, 0.0, fault.name, withAxes(tracks_.given(), fault));
    }
  }
  void tryWorldTwist() {
    const Poses turned_back = fromWorldTwist(tracks_.given());
    attempt(OdometryCause::kWorldTwist, 0.0, "", turned(turned_back, tracks_.mountingYaw(turned_back)));
  }

  CauseFinding result() const {
    CauseFinding result = best_;
    if (best_.remaining < kMended * best_.before) return result;
    result.cause = OdometryCause::kUnknown;
    result.remaining = best_.before;
    return result;
  }

 private:
  void attempt(OdometryCause cause, double figure, const std::string& detail, const Poses& corrected) {
    const double harm = tracks_.meanHarm(corrected);
    if (!(harm < best_.remaining)) return;
    best_ = {cause, figure, detail, best_.before, harm};
  }

  ComparedTracks tracks_;
  CauseFinding best_;
};

}  // namespace

std::string describe(const CauseFinding& finding) {
  switch (finding.cause) {
    case OdometryCause::kMountingYaw:
      return textOf("the yaw of the mounting, believed %.1f degrees too far to the %s",
                    std::abs(finding.figure) * 180.0 / kPi, finding.figure > 0.0 ? "right" : "left");
    case OdometryCause::kScale: return textOf("its scale, %.3f times the true lengths", finding.figure);
    case OdometryCause::kTimeOffset: return textOf("its stamps, %.3f s late", finding.figure);
    case OdometryCause::kAxes: return "its axes: " + finding.detail;
    case OdometryCause::kWorldTwist: return "velocities in the axes of the fixed frame, not of the vehicle";
    case OdometryCause::kFrozen: return textOf("it stood still for %.0f scans of a moving vehicle", finding.figure);
    case OdometryCause::kJump: return textOf("it jumped by %.2f m", finding.figure);
    case OdometryCause::kUnknown: break;
  }
  return "not known: no single correction mends it";
}

CauseFinding findCause(const std::deque<ComparedScan>& scans, const ComparisonWindow& window, bool is_twist) {
  CauseSearch search(scans, window);
  search.tryMounting();
  search.tryScale();
  search.tryTimeOffset();
  search.tryAxes();
  if (is_twist) search.tryWorldTwist();
  search.tryFrozen();
  search.tryJumps();
  return search.result();
}

}  // namespace donex
