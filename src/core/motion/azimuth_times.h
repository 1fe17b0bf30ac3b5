// Times of a spinning sensor's echoes by their azimuth, for clouds that carry none.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/motion/spin.h"

namespace donex {

/// Whole turns, or more than half of one; clouds follow one another `interval` seconds apart, and how far the sensor
/// turns in that time is how far the next cloud's begin is ahead of this one's.
class AzimuthTimes {
 public:
  /// Takes the clouds of one sensor by their stamps [s]; the same one may be read again. `times`: of each echo after
  /// the cloud's begin [s]. False where they cannot be told: then `times` is empty.
  bool read(double stamp, const std::vector<Eigen::Vector3f>& echoes, std::size_t columns, double interval,
            std::vector<float>& times);

  /// Of the cloud that was read last.
  const Spin& spin() const { return spin_; }

 private:
  struct Begin {
    double stamp;  // [s]
    float start;   // [turns]
  };
  void follow(const Begin& begin, double interval);

  Spin spin_;
  std::optional<Begin> before_;
  std::optional<float> advance_;  // from one cloud's begin to the next one's [turns]
};

}  // namespace donex
