// An alarm that needs no cause: when a third of a scan becomes dynamic at once, it is never the world.
#pragma once

#include <cstdint>
#include <vector>

#include "donex/scan.h"

namespace donex {

class FloodWatch {
 public:
  struct Options {
    double flood = 1.0 / 3.0;  ///< share of the judged echoes; among traffic and few beams a sixth moves indeed
    double usual = 0.05;       ///< share before, above which much moves indeed
    std::size_t echoes = 500;  ///< judged ones in a scan, fewer tell nothing
    int settled = 10;          ///< scans until the usual share is known
    int scans = 2;             ///< flooded ones in a row
  };

  FloodWatch() = default;
  explicit FloodWatch(const Options& options) : options_(options) {}

  /// The share of dynamic echoes among the judged ones, when the alarm begins with this scan; else 0.
  double follow(const EchoLabels& labels);

  /// The grid is empty: what it takes for new says nothing yet.
  void reset() { *this = FloodWatch(options_); }

 private:
  Options options_;
  double usual_ = 0.0;  // share, fading
  int seen_ = 0, flooded_ = 0;
};

}  // namespace donex
