// Turns for the methods that keep no sight images.
#pragma once

#include <vector>

#include "core/sight/turns.h"

namespace donex {

/// Tells turns by a sample of the echoes: directions need no more.
class SampledTurns {
 public:
  /// Takes the next cloud.
  TurnPart arrive(const Scan& scan);
  std::size_t cloudsPerTurn() const { return turns_.cloudsPerTurn(); }
  void reset() { turns_.reset(); }

  std::size_t memoryBytes() const;
  /// What memoryBytes will be for scans of so many echoes [bytes].
  static double bytesFor(double echoes);

  static constexpr std::size_t kSample = 8192;  ///< echoes; eight per column of a whole turn

 private:
  Turns turns_;
  std::vector<Eigen::Vector3f> sample_;
  std::vector<std::uint8_t> is_echo_;  ///< all 1: what is none has no direction
  SightPixels pixels_;
};

}  // namespace donex
