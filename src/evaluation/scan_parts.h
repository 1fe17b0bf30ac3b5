// A scan cut into parts, as a driver that does not wait for the turn would have published it.
#pragma once

#include <cstdint>
#include <vector>

#include "core/sector.h"
#include "donex/scan.h"

namespace donex {

/// Sectors of equal azimuth, counter-clockwise from straight ahead. An echo without a direction is in the first one.
class ScanParts {
 public:
  /// Throws std::invalid_argument where `parts` is none, or more than kMost.
  explicit ScanParts(std::size_t parts);

  std::size_t count() const { return parts_.size(); }

  /// Cuts a scan that took `duration` [s]: parts keep its pose, which its echoes are given for, and have a stamp each,
  /// the first one the scan's.
  void cut(const Scan& scan, double duration);
  /// A part of the last cut, in the order of their stamps.
  const Scan& operator[](std::size_t part) const { return parts_[part]; }

  /// Which echoes of the whole scan a part of the last cut has.
  const std::vector<std::uint32_t>& echoesOf(std::size_t part) const { return echoes_of_part_.at(part); }

  /// Enters the labels of a part of the last cut into those of the whole scan, which have room for all of them.
  void putBack(std::size_t part, const EchoLabels& labels, EchoLabels& whole) const;

  static constexpr std::size_t kMost = kMostSectors;

 private:
  std::vector<Scan> parts_;
  std::vector<std::vector<std::uint32_t>> echoes_of_part_;  ///< indices into the whole scan
};

}  // namespace donex
