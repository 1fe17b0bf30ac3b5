// An alarm that needs no cause: when a third of a scan becomes dynamic at once, it is never the world.
#pragma once

#include <cstddef>

#include "donex/scan.h"

namespace donex {

class FloodWatch {
 public:
  struct Options {
    double flood = 1.0 / 3.0;  ///< share of the judged echoes; among traffic and few beams a sixth moves indeed
    double usual = 0.05;       ///< share before, above which much moves indeed
    std::size_t echoes = 500;  ///< judged ones in a look, fewer tell nothing
    double look = 0.09;        ///< clouds are counted together for so long: a part of a turn may be all traffic [s]
    double settled = 0.95;     ///< until the usual share is known [s]
    double usual_time = 0.95;  ///< over which the usual share fades [s]
    int looks = 2;             ///< flooded ones in a row
  };

  FloodWatch() = default;
  explicit FloodWatch(const Options& options) : options_(options) {}

  /// The labels of a cloud of this stamp [s]; stamps grow. The share of dynamic echoes among the judged ones, when the
  /// alarm begins with it; else 0.
  double follow(double stamp, const EchoLabels& labels);

  /// The grid is empty: what it takes for new says nothing yet.
  void reset() { *this = FloodWatch(options_); }

 private:
  double judge(double stamp, double share);

  Options options_;
  bool has_begun_ = false;
  double first_ = 0.0;                    ///< stamp of the first cloud [s]
  double last_look_ = 0.0;                ///< when the last look ended [s]
  std::size_t judged_ = 0, dynamic_ = 0;  ///< in the look so far
  double usual_ = 0.0;                    ///< share, fading
  bool has_usual_ = false;
  int flooded_ = 0;  ///< looks in a row
};

}  // namespace donex
