#include "ros/flood_watch.h"

#include <algorithm>
#include <cmath>

namespace donex {

double FloodWatch::follow(double stamp, const EchoLabels& labels) {
  if (!has_begun_) {
    has_begun_ = true;
    first_ = stamp;
    last_look_ = stamp - options_.look;
  }
  judged_ += static_cast<std::size_t>(std::count(labels.observed.begin(), labels.observed.end(), 1));
  dynamic_ += static_cast<std::size_t>(std::count(labels.dynamic.begin(), labels.dynamic.end(), 1));
  if (stamp - last_look_ < options_.look) return 0.0;
  const double share = static_cast<double>(dynamic_) / static_cast<double>(std::max<std::size_t>(judged_, 1));
  const double alarm = judged_ < options_.echoes ? 0.0 : judge(stamp, share);
  last_look_ = stamp;
  judged_ = dynamic_ = 0;
  return alarm;
}

double FloodWatch::judge(double stamp, double share) {
  const bool is_flood = stamp - first_ >= options_.settled && usual_ < options_.usual && share > options_.flood;
  flooded_ = is_flood ? flooded_ + 1 : 0;
  if (is_flood) return flooded_ == options_.looks ? share : 0.0;
  const double newest = has_usual_ ? 1.0 - std::exp(-(stamp - last_look_) / options_.usual_time) : 1.0;
  usual_ += newest * (share - usual_);
  has_usual_ = true;
  return 0.0;
}

}  // namespace donex
