#include "core/objects/near_what_moves.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/grid/line_of_sight.h"
#include "core/grid/selection.h"
#include "core/grid/simd.h"
#include "core/grid/storage.h"

namespace donex {
namespace {

/// A square of parts of cells, seen from its middle.
struct PartsAround {
  Eigen::Vector2f sensor;   ///< [m]
  float per_part;           ///< [1/m]
  int middle, first, last;  ///< the sensor's, and those that are inside, along both axes
};

/// The parts of cells that echoes lie in; 0 where one is outside. Echoes may be NaN.
DONEX_WIDE_LOOPS void placeAll(const PartsAround& around, const float* echoes, std::size_t count, std::uint16_t* xs,
                               std::uint16_t* ys) {
  const float per_part = around.per_part, sensor_x = around.sensor.x(), sensor_y = around.sensor.y();
  const int first = around.first, last = around.last, middle = around.middle;
  const auto beyond = static_cast<float>(middle);
  for (std::size_t i = 0; i < count; ++i) {
    const int x = floorToInt(clampedTo(-beyond, beyond, (echoes[3 * i] - sensor_x) * per_part)) + middle;
    const int y = floorToInt(clampedTo(-beyond, beyond, (echoes[3 * i + 1] - sensor_y) * per_part)) + middle;
    const int inside = static_cast<int>(x >= first) & static_cast<int>(x <= last) & static_cast<int>(y >= first) &
                       static_cast<int>(y <= last);
    xs[i] = static_cast<std::uint16_t>(x * inside);
    ys[i] = static_cast<std::uint16_t>(y * inside);
  }
}

}  // namespace

NearWhatMoves::NearWhatMoves(double reach, float within)
    : within_(within),
      per_part_(static_cast<float>(kParts) / within),
      width_(widthOf(reach, within)),
      nearness_(std::size_t{width_} * width_, Nearness::kOutside),
      number_of_(nearness_.size(), kNone) {
  for (std::uint32_t y = kRim; y < width_ - kRim; ++y) {
    std::fill_n(nearness_.begin() + y * width_ + kRim, width_ - 2 * kRim, Nearness::kFar);
  }
}

std::uint32_t NearWhatMoves::widthOf(double reach, float within) {
  return 2 * (static_cast<std::uint32_t>(std::ceil(reach / within)) + kRim) + 1;
}

bool NearWhatMoves::take(const JudgedScan& scan, const Segments& segments, const Verdicts& verdicts,
                         const std::vector<Proof>& proofs) {
  if (std::none_of(verdicts.begin(), verdicts.end(), [](const Verdict& verdict) { return verdict.moves(); }))
    return false;
  scan_ = &scan;
  place(scan);
  takeMoving(segments, verdicts, proofs);
  moving_cells_ = cells_.size();
  if (moving_cells_ == 0) return false;
  mark(2, Nearness::kBeside);
  mark(1, Nearness::kNear);
  takeStanding(proofs);
  return true;
}

void NearWhatMoves::place(const JudgedScan& scan) {
  resizeTo(x_, scan.points.size());
  resizeTo(y_, scan.points.size());
  constexpr int kFirst = static_cast<int>(kRim * kParts);
  const auto parts = static_cast<int>(width_ * kParts);
  const PartsAround around{scan.sensor.head<2>(), per_part_, static_cast<int>(width_ / 2 * kParts), kFirst,
                           parts - kFirst - 1};
  placeAll(around, scan.points.front().data(), scan.points.size(), x_.data(), y_.data());
}

void NearWhatMoves::takeMoving(const Segments& segments, const Verdicts& verdicts, const std::vector<Proof>& proofs) {
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (!verdicts[i].moves()) continue;
    for (const std::uint32_t echo : segments[i].echoes) {
      const bool is_trimmed = proofs[echo] == Proof::kNone;
      if (!is_trimmed && of(echo) != Nearness::kOutside) add(echo, static_cast<int>(i));
    }
  }
}

void NearWhatMoves::takeStanding(const std::vector<Proof>& proofs) {
  const auto stands = [&](std::size_t i) {
    return of(i) >= Nearness::kBeside && scan_->roles[i] == ClusterRole::kConnects && proofs[i] == Proof::kNone;
  };
  forEachSelection(0, scan_->points.size(), stands, [&](const std::uint32_t* chosen, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) add(chosen[k], kStands);
  });
}

void NearWhatMoves::add(std::uint32_t echo, int segment) {
  const std::uint32_t x = x_[echo], y = y_[echo];
  int& number = number_of_[cellOf(x, y)];
  if (number == kNone) {
    number = static_cast<int>(cells_.size());
    cells_.push_back({x / kParts, y / kParts, {}, {}});
  }
  Cell& cell = cells_[static_cast<std::size_t>(number)];
  Lowest& lowest = (segment == kStands ? cell.standing : cell.moving)[y % kParts * kParts + x % kParts];
  const bool is_lower =
      lowest.echo == kNone || scan_->heights[echo] < scan_->heights[static_cast<std::size_t>(lowest.echo)];
  if (is_lower) lowest = {static_cast<int>(echo), segment};
}

/// The cells in the square around those where something moves, up to so many away.
void NearWhatMoves::mark(std::uint32_t away, Nearness nearness) {
  for (std::size_t k = 0; k < moving_cells_; ++k) {
    for (std::uint32_t y = cells_[k].y - away; y <= cells_[k].y + away; ++y) {
      Nearness* first = &nearness_[std::size_t{y} * width_ + cells_[k].x - away];
      const auto is_inside = [](Nearness known) { return known != Nearness::kOutside; };
      std::replace_if(first, first + 2 * away + 1, is_inside, nearness);
    }
  }
}

void NearWhatMoves::forget() {
  mark(2, Nearness::kFar);
  for (const Cell& cell : cells_) number_of_[std::size_t{cell.y} * width_ + cell.x] = kNone;
  cells_.clear();
  moving_cells_ = 0;
}

NearWhatMoves::Nearness NearWhatMoves::at(const Eigen::Vector2f& from_sensor) const {
  const int middle = static_cast<int>(width_ / 2);
  const auto beyond = static_cast<float>(middle);
  const auto in = [&](float meters) {
    return static_cast<std::size_t>(floorToInt(clampedTo(-beyond, beyond, meters / within_)) + middle);
  };
  return nearness_[in(from_sensor.y()) * width_ + in(from_sensor.x())];
}

/// Of the echoes in its cell and the eight around it: none elsewhere is near.
NearWhatMoves::Nearest NearWhatMoves::nearestTo(std::size_t echo) const {
  Nearest nearest{kStands, within_ * within_};
  const Eigen::Vector2f place = scan_->points[echo].head<2>();
  const auto look = [&](const Lowest& lowest) {
    if (lowest.echo == kNone) return;
    const Eigen::Vector3f& point = scan_->points[static_cast<std::size_t>(lowest.echo)];
    const float distance = (point.head<2>() - place).squaredNorm();
    if (distance <= nearest.squared_distance) nearest = {lowest.segment, distance};
  };
  const std::size_t middle = cellOf(x_[echo], y_[echo]);
  for (std::size_t row = middle - width_; row <= middle + width_; row += width_) {
    for (std::size_t beside = row - 1; beside <= row + 1; ++beside) {
      if (number_of_[beside] == kNone) continue;
      const Cell& cell = cells_[static_cast<std::size_t>(number_of_[beside])];
      for (const Lowest& moving : cell.moving) look(moving);
      for (const Lowest& standing : cell.standing) look(standing);
    }
  }
  return nearest;
}

double NearWhatMoves::bytesFor(double reach, float within, double echoes) {
  return std::pow(widthOf(reach, within), 2) * (sizeof(int) + sizeof(Nearness)) +
         roomFor(2 * sizeof(std::uint16_t) * echoes);
}

std::size_t NearWhatMoves::memoryBytes() const {
  return (x_.capacity() + y_.capacity()) * sizeof(std::uint16_t) + nearness_.capacity() * sizeof(Nearness) +
         number_of_.capacity() * sizeof(int) + cells_.capacity() * sizeof(Cell);
}

}  // namespace donex
