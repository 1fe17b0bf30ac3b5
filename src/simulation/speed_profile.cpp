#include "simulation/speed_profile.h"

#include <algorithm>
#include <cmath>

namespace donex::simulation {

SpeedProfile::SpeedProfile(std::vector<Knot> knots) : knots_(std::move(knots)) {
  distances_.push_back(0.0);
  for (std::size_t i = 1; i < knots_.size(); ++i) {
    const double mean = 0.5 * (knots_[i - 1].speed + knots_[i].speed);
    distances_.push_back(distances_.back() + mean * (knots_[i].time - knots_[i - 1].time));
  }
}

SpeedProfile& SpeedProfile::repeat() {
  repeats_ = knots_.size() > 1;
  return *this;
}

double SpeedProfile::wrapped(double time) const {
  if (!repeats_) return time;
  const double period = knots_.back().time - knots_.front().time;
  return time - period * std::floor((time - knots_.front().time) / period);
}

double SpeedProfile::speed(double time) const {
  time = wrapped(time);
  const auto after = std::upper_bound(knots_.begin(), knots_.end(), time,
                                      [](double value, const Knot& knot) { return value < knot.time; });
  if (after == knots_.begin()) return knots_.front().speed;
  if (after == knots_.end()) return knots_.back().speed;
  const Knot& before = *std::prev(after);
  return before.speed + (after->speed - before.speed) * (time - before.time) / (after->time - before.time);
}

double SpeedProfile::distance(double time) const {
  const double inside = wrapped(time);
  double whole = 0.0;
  if (repeats_) {
    const double period = knots_.back().time - knots_.front().time;
    whole = std::round((time - inside) / period) * distances_.back();
  }
  const auto after = std::upper_bound(knots_.begin(), knots_.end(), inside,
                                      [](double value, const Knot& knot) { return value < knot.time; });
  const std::size_t i = after == knots_.begin() ? 0 : static_cast<std::size_t>(after - knots_.begin()) - 1;
  return whole + distances_[i] + 0.5 * (knots_[i].speed + speed(inside)) * (inside - knots_[i].time);
}

}  // namespace donex::simulation
