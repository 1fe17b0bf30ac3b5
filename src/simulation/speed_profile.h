// How fast something goes, and how far it has come.
#pragma once

#include <vector>

namespace donex::simulation {

/// Speed over time: linear between knots, constant before the first and after the last; or repeated for ever.
class SpeedProfile {
 public:
  struct Knot {
    double time;   ///< [s]
    double speed;  ///< [m/s]
  };

  explicit SpeedProfile(double speed) : SpeedProfile({{0.0, speed}}) {}
  /// Knots by rising time, at least one.
  explicit SpeedProfile(std::vector<Knot> knots);

  /// Repeats [first knot, last knot] in both directions of time.
  SpeedProfile& repeat();

  double speed(double time) const;
  /// From the first knot's time to `time`; negative before [m].
  double distance(double time) const;

 private:
  double wrapped(double time) const;

  std::vector<Knot> knots_;
  std::vector<double> distances_;  ///< at the knots
  bool repeats_ = false;
};

}  // namespace donex::simulation
