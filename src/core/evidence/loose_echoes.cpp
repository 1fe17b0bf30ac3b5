#include "core/evidence/loose_echoes.h"

#include <algorithm>
#include <cmath>

#include "core/grid/storage.h"

namespace donex {

/// In clear air most turns are let pass.
void LooseEchoes::beginTurn(double stamp) {
  const double elapsed = std::max(stamp - looked_, 0.0);  // other sensors' clouds may come a little late
  looks_ = !isAirClear() || elapsed >= options_.interval;
  if (!looks_) return;
  const double kept = std::exp(-elapsed / options_.memory);
  for (Air& air : air_) air.echoes *= kept, air.alone *= kept;
  looked_ = std::max(stamp, looked_);
}

void LooseEchoes::loosen(TurnPart part, double stamp, const SightPixels& seen, std::vector<ClusterRole>& roles) {
  if (part != TurnPart::kContinuing) beginTurn(stamp);
  if (!looks_) return;
  sort(seen);
  judgeAir();
  const bool was_clear = isAirClear();
  for (std::size_t i = 0; i < roles.size(); i += was_clear ? options_.sample : 1) {
    if (roles[i] != ClusterRole::kConnects || seen.row(i) < 0) continue;
    const Count count = neighboursOf(seen, i);
    learnAir(seen.range(i), count.isAlone());
    const bool is_loose = !was_clear && count.neighbours > 0 && count.alike < options_.share * count.neighbours;
    if (is_loose) roles[i] = ClusterRole::kLoose;
  }
  judgeAir();
  // Where drops are everywhere, some are close by to one another, and to what is solid.
  const bool is_plume = !was_clear && !air_[0].is_thick;
  if (is_plume) smooth(seen, roles);
}

void LooseEchoes::learnAir(float range, bool is_alone) {
  for (std::size_t i = 0; i < air_.size(); ++i) {
    const bool is_near = range * SightPixels::kRangeStep < static_cast<float>(options_.thick_air[i].range);
    if (!is_near) continue;
    ++air_[i].echoes;
    air_[i].alone += is_alone ? 1.0 : 0.0;
  }
}

void LooseEchoes::judgeAir() {
  for (std::size_t i = 0; i < air_.size(); ++i) {
    const double share = (air_[i].is_thick ? options_.clears : 1.0) * options_.thick_air[i].share;
    air_[i].is_thick = air_[i].alone >= options_.least && air_[i].alone > share * air_[i].echoes;
  }
}

bool LooseEchoes::loosenPlume(const SightPixels& seen, const std::uint32_t* echoes, std::size_t count,
                              std::vector<ClusterRole>& roles) const {
  if (!looks_ || isAirClear()) return false;
  const float reach = static_cast<float>(options_.thick_air[1].range) / SightPixels::kRangeStep;
  std::size_t far = 0, asked = 0;
  double alike = 0.0;
  const auto is_seen = [&](std::uint32_t echo) { return echo < seen.size() && seen.row(echo) >= 0; };
  for (std::size_t i = 0; i < count; i += count / options_.plume_sample + 1) {
    if (!is_seen(echoes[i])) continue;
    const Count around = neighboursOf(seen, echoes[i]);
    if (seen.range(echoes[i]) > reach) {
      ++far;
    } else if (around.neighbours > 0) {
      ++asked;
      alike += static_cast<double>(around.alike) / around.neighbours;
    }
  }
  const bool is_plume = asked > far && alike < options_.plume_share * static_cast<double>(asked);
  for (std::size_t i = 0; is_plume && i < count; ++i) {
    if (is_seen(echoes[i])) roles[echoes[i]] = ClusterRole::kLoose;
  }
  return is_plume;
}

/// In a plume a few echoes happen to have others alike beside them, and an edge of something solid has few: what most
/// echoes close by are tells.
void LooseEchoes::smooth(const SightPixels& seen, std::vector<ClusterRole>& roles) {
  turned_.clear();
  for (std::uint32_t i = 0; i < seen.size(); ++i) {
    const bool is_loose = roles[i] == ClusterRole::kLoose;
    if (seen.row(i) < 0 || (roles[i] != ClusterRole::kConnects && !is_loose)) continue;
    int loose = 0, connect = 0;
    forEachCloseBy(seen, i, [&](std::uint32_t other) {
      if (other == i) return;
      loose += roles[other] == ClusterRole::kLoose ? 1 : 0;
      connect += roles[other] == ClusterRole::kConnects ? 1 : 0;
    });
    const double most = (is_loose ? options_.loose_stays : options_.loose_spreads) * (loose + connect);
    if (is_loose ? loose < most : loose > most) turned_.push_back(i);
  }
  for (const std::uint32_t i : turned_) {
    roles[i] = roles[i] == ClusterRole::kLoose ? ClusterRole::kConnects : ClusterRole::kLoose;
  }
}

/// A column's pixels lie side by side: those above one another are found at once.
std::size_t LooseEchoes::pixelOf(int column, int row) const {
  return static_cast<std::size_t>(column & (SightPixels::kColumns - 1)) * static_cast<std::size_t>(rows_) +
         static_cast<std::size_t>(row - lowest_row_);
}

/// The echoes by pixel: a counting sort over the rows that there are.
void LooseEchoes::sort(const SightPixels& seen) {
  const SightPixels::Span span = seen.span();
  lowest_row_ = span.lowest;
  rows_ = std::max(span.highest - span.lowest + 1, 0);
  if (first_in_.empty()) first_in_.reserve(static_cast<std::size_t>(SightPixels::kColumns) * SightPixels::kRows + 1);
  first_in_.assign(static_cast<std::size_t>(SightPixels::kColumns) * static_cast<std::size_t>(rows_) + 1, 0);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen.row(i) >= 0) ++first_in_[pixelOf(seen.column(i), seen.row(i))];
  }
  std::uint32_t end = 0;
  for (std::uint32_t& first : first_in_) first = end += first;
  resizeTo(order_, seen.size());
  for (std::uint32_t i = 0; i < seen.size(); ++i) {
    if (seen.row(i) >= 0) order_[--first_in_[pixelOf(seen.column(i), seen.row(i))]] = i;
  }
}

LooseEchoes::Count LooseEchoes::neighboursOf(const SightPixels& seen, std::size_t echo) const {
  for (int reach = 1; reach <= options_.farthest; ++reach) {
    const Count count = countAround(seen, echo, reach);
    if (count.neighbours >= options_.neighbours) return count;
  }
  return {};
}

template <class Visit>
void LooseEchoes::forEachCloseBy(const SightPixels& seen, std::size_t echo, Visit&& visit) const {
  const float close_by = static_cast<float>(options_.close_by) / SightPixels::kRangeStep;
  forEachAround(seen, echo, options_.close_pixels, [&](std::uint32_t other) {
    if (std::abs(seen.range(other) - seen.range(echo)) <= close_by) visit(other);
  });
}

template <class Visit>
void LooseEchoes::forEachAround(const SightPixels& seen, std::size_t echo, int reach, Visit&& visit) const {
  const int column = seen.column(echo), row = seen.row(echo);
  const int lowest = std::max(row - reach, lowest_row_), highest = std::min(row + reach, lowest_row_ + rows_ - 1);
  for (int c = column - reach; c <= column + reach; ++c) {
    const std::uint32_t last = first_in_[pixelOf(c, highest) + 1];
    for (std::uint32_t i = first_in_[pixelOf(c, lowest)]; i < last; ++i) visit(order_[i]);
  }
}

LooseEchoes::Count LooseEchoes::countAround(const SightPixels& seen, std::size_t echo, int reach) const {
  const float range = seen.range(echo);
  const float like =
      static_cast<float>(options_.like) / SightPixels::kRangeStep + static_cast<float>(options_.like_angle) * range;
  Count count{-1, -1, 0};  // the echo finds itself
  forEachAround(seen, echo, reach, [&](std::uint32_t other) {
    ++count.neighbours;
    count.nearer += seen.range(other) < range ? 1 : 0;
    count.alike += std::abs(seen.range(other) - range) <= like ? 1 : 0;
  });
  return count;
}

void LooseEchoes::join(const SightPixels& seen, const std::vector<ClusterRole>& roles, std::vector<Proof>& proofs) {
  if (!looks_ || isAirClear()) return;
  joined_.clear();
  for (std::uint32_t i = 0; i < seen.size(); ++i) {
    if (roles[i] != ClusterRole::kLoose) continue;
    int moving = 0, standing = 0;
    std::uint32_t of = i;
    forEachCloseBy(seen, i, [&](std::uint32_t other) {
      if (roles[other] == ClusterRole::kLoose) return;
      const bool moves = proofs[other] != Proof::kNone;
      ++(moves ? moving : standing);
      if (moves) of = other;
    });
    if (moving > options_.moving_share * (moving + standing)) joined_.push_back({i, of});
  }
  for (const Joined& joined : joined_) proofs[joined.echo] = proofs[joined.of];
}

double LooseEchoes::bytesFor(double echoes) {
  constexpr double kPixels = static_cast<double>(SightPixels::kColumns) * SightPixels::kRows;
  return (kPixels + 1.0) * sizeof(std::uint32_t) + roomFor((2 * sizeof(std::uint32_t) + sizeof(Joined)) * echoes);
}

std::size_t LooseEchoes::memoryBytes() const {
  return first_in_.capacity() * sizeof(std::uint32_t) +
         (order_.capacity() + turned_.capacity()) * sizeof(std::uint32_t) + joined_.capacity() * sizeof(Joined);
}

}  // namespace donex
