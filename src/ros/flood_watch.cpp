#include "ros/flood_watch.h"

#include <algorithm>

namespace donex {

double FloodWatch::follow(const EchoLabels& labels) {
  const auto judged = static_cast<std::size_t>(std::count(labels.observed.begin(), labels.observed.end(), 1));
  if (judged < options_.echoes) return 0.0;
  const auto dynamic = std::count(labels.dynamic.begin(), labels.dynamic.end(), 1);
  const double share = static_cast<double>(dynamic) / static_cast<double>(judged);
  const bool is_flood = seen_ >= options_.settled && usual_ < options_.usual && share > options_.flood;
  flooded_ = is_flood ? flooded_ + 1 : 0;
  if (is_flood) return flooded_ == options_.scans ? share : 0.0;
  constexpr double kFading = 0.1;
  usual_ = seen_ == 0 ? share : usual_ + kFading * (share - usual_);
  ++seen_;
  return 0.0;
}

}  // namespace donex
