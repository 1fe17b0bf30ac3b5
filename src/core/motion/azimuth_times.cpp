#include "core/motion/azimuth_times.h"

#include <cmath>

namespace donex {
namespace {

constexpr double kNextCloud = 1.5;      // a cloud within so many intervals is the next one
constexpr float kCloudsOverlap = 0.1F;  // of clouds that follow one another [turns]
constexpr float kWholeTurn = 0.9F;      // the next cloud begins where this one ends [turns]
constexpr double kSlowestTurn = 0.5;    // no sensor takes longer for what a cloud holds [s]

}  // namespace

bool AzimuthTimes::read(double stamp, const std::vector<Eigen::Vector3f>& echoes, std::size_t columns, double interval,
                        std::vector<float>& times) {
  times.clear();
  if (!spin_.look(echoes, columns)) return false;
  follow({stamp, spin_.start()}, interval);
  if (!advance_ && spin_.turned() > kWholeTurn) advance_ = spin_.turned();
  if (!advance_ || interval * static_cast<double>(spin_.turned() / *advance_) > kSlowestTurn) return false;
  spin_.turnsOf(echoes, times);
  const auto seconds_per_turn = static_cast<float>(interval) / *advance_;
  for (float& time : times) time *= seconds_per_turn;
  return true;
}

/// A sensor whose clouds are cut to what lies ahead turns on behind: once around from begin to begin. One whose clouds
/// hold two thirds of a turn begins the next where it has ended this one.
void AzimuthTimes::follow(const Begin& begin, double interval) {
  const bool is_next = before_ && begin.stamp > before_->stamp && begin.stamp < before_->stamp + kNextCloud * interval;
  if (is_next) {
    const float ahead = (spin_.isClockwise() ? -1.0F : 1.0F) * (begin.start - before_->start);
    const float advance = ahead - std::floor(ahead);
    advance_ = advance < spin_.turned() - kCloudsOverlap ? advance + 1.0F : advance;
  }
  before_ = begin;
}

}  // namespace donex
