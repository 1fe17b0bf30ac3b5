// Corrections of an odometry, as its faults ask for them, and what two tracks tell of their size.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "core/motion/track_comparison.h"

namespace donex {

/// Axes that were swapped or flipped on the way: `position` and the turns of the fixed frame in the wrong axes.
struct AxisFault {
  std::string name;
  Eigen::Matrix2d position;  ///< what undoes it
  double turn_sign;          ///< of yaw
};

const std::vector<AxisFault>& axisFaults();
Poses withAxes(const Poses& given, const AxisFault& fault);

/// The vehicle turned in place, by `yaw` to the left [rad].
Poses turned(const Poses& given, double yaw);
Poses scaled(const Poses& given, double factor);
/// Of integrated velocities that were told in the fixed frame's axes: their heading counted twice is counted once.
Poses fromWorldTwist(const Poses& given);

/// Poses with the scans' own motion where the odometry's cannot be.
struct Repair {
  Poses poses;
  std::size_t scans = 0;  ///< replaced
  double size = 0.0;      ///< of the largest difference in one scan [m]
};

/// Both tracks, and the windows over which they are compared.
class ComparedTracks {
 public:
  ComparedTracks(const std::deque<ComparedScan>& scans, const ComparisonWindow& window);

  const Poses& given() const { return given_; }
  std::size_t windows() const { return windows_.size(); }
  double way() const;  ///< by the scans [m]
  double meanHarm(const Poses& corrected) const;

  /// How far the sensor is mounted to the left of where it is believed to be [rad].
  double mountingYaw(const Poses& given) const;
  /// The odometry's lengths over those of the scans.
  double scale(const Poses& given) const;
  /// By how much the stamps are late, in steps of 10 ms within 0.3 s [s].
  double timeOffset(const Poses& given) const;
  /// The odometry as it was `offset` later [s]; beyond the ends its motion goes on.
  Poses shifted(const Poses& given, double offset) const;

  Repair withoutJumps() const;
  Repair withoutFrozen() const;

  /// The motions over a window, of the odometry and of the scans, in x and y [m].
  struct Motions {
    Eigen::Vector2d given, found;
  };
  std::vector<Motions> motions(const Poses& given) const;

 private:
  struct Window {
    std::size_t first, last;
  };

  double stepDifference(std::size_t scan) const;
  bool isFrozen(std::size_t scan) const;
  Repair replaced(const std::vector<bool>& is_wrong) const;

  std::vector<double> stamps_;
  Poses given_, found_;
  std::vector<Window> windows_;
};

}  // namespace donex
