#include "core/sight/sampled_turns.h"

#include <algorithm>

namespace donex {

TurnPart SampledTurns::arrive(const Scan& scan) {
  // An odd step meets every beam in turn, where a cloud has them column by column.
  const std::size_t step = (scan.echoes.size() / kSample) | 1;
  sample_.clear();
  for (std::size_t i = 0; i < scan.echoes.size(); i += step) sample_.push_back(scan.echoes[i]);
  is_echo_.assign(sample_.size(), 1);
  pixels_.project(sample_, is_echo_);
  return turns_.arrive(scan, pixels_);
}

std::size_t SampledTurns::memoryBytes() const {
  return sample_.capacity() * sizeof(Eigen::Vector3f) + is_echo_.capacity() + pixels_.memoryBytes() +
         turns_.memoryBytes();
}

double SampledTurns::bytesFor(double echoes) {
  const double sample = std::min(echoes, 2.0 * kSample);  // with a step of 1 there are up to twice as many
  return sample * (sizeof(Eigen::Vector3f) + 1.0) + SightPixels::bytesFor(sample);
}

}  // namespace donex
