// What a stream of scans must hold to: refused before it can touch a memory.
#pragma once

#include <limits>

#include "donex/scan.h"

namespace donex {

class StreamGuard {
 public:
  /// Throws std::invalid_argument where the scan's stamp is earlier than the last one's (sensors whose clocks are
  /// synchronised share their stamps), or where a stamp or pose is not finite, not rigid, or farther than kFarthestPose
  /// from the odometry's origin, or second returns are told of another number of echoes.
  void admit(const Scan& scan);
  void reset() { last_stamp_ = -std::numeric_limits<double>::infinity(); }

  static constexpr double kFarthestPose = 1e7;  // [m]: voxel indices stay far inside an int's range

 private:
  double last_stamp_ = -std::numeric_limits<double>::infinity();
};

}  // namespace donex
