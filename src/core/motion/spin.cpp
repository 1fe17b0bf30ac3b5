#include "core/motion/spin.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/azimuth.h"
#include "core/pi.h"

namespace donex {
namespace {

float turnsAt(const Eigen::Vector2f& direction) { return azimuthOf(direction.y(), direction.x()) / (2.0F * kPiF); }

/// The shorter way [turns], -0.5 to 0.5.
float shortest(float turns) { return turns - std::round(turns); }

/// Of length 1; zero where the echo has none.
Eigen::Vector2f directionOf(const Eigen::Vector3f& echo) {
  const float across = echo.head<2>().norm();
  const bool has_one = across > 0.0F && std::isfinite(across);
  return has_one ? Eigen::Vector2f(echo.head<2>() / across) : Eigen::Vector2f::Zero();
}

}  // namespace

bool Spin::look(const std::vector<Eigen::Vector3f>& echoes, std::size_t columns) {
  count_ = echoes.size();
  columns_ = columns;
  const bool is_organised = columns > 1 && columns < count_;
  order_ = Order::kFirings;
  if (isInOrder(echoes)) return true;
  order_ = Order::kRows;
  if (is_organised && isInOrder(echoes)) return true;
  order_ = Order::kRings;
  return isRingByRing(echoes);
}

/// Where in the cloud's order, 0 to the number of slices.
float Spin::placeOf(std::size_t echo) const {
  const bool in_rows = order_ == Order::kRows;
  const std::size_t length = in_rows ? columns_ : count_, place = in_rows ? echo % columns_ : echo;
  return (static_cast<float>(place) + 0.5F) / static_cast<float>(length) * static_cast<float>(options_.slices);
}

/// Whether slice after slice lies farther around, as the sensor turns.
bool Spin::isInOrder(const std::vector<Eigen::Vector3f>& echoes) {
  slice(echoes);
  if (!tie()) return false;
  reachToTheEnds();
  return turned_ >= options_.least_turned && turned_ <= options_.most_turned;
}

void Spin::slice(const std::vector<Eigen::Vector3f>& echoes) {
  slices_.assign(options_.slices, {});
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    const Eigen::Vector2f direction = directionOf(echoes[i]);
    if (direction.isZero(0.0F)) continue;
    Directions& slice = slices_[std::min(static_cast<std::size_t>(placeOf(i)), options_.slices - 1)];
    slice.sum += direction;
    ++slice.count;
  }
}

/// The way from slice to slice; false where it is none that a sensor turns.
bool Spin::tie() {
  knots_.clear();
  float turned = 0.0F, way = 0.0F;
  for (std::size_t k = 0; k < slices_.size(); ++k) {
    const Directions& slice = slices_[k];
    if (slice.count == 0) continue;
    if (slice.sum.norm() < options_.least_bundled * static_cast<float>(slice.count)) return false;
    if (knots_.empty()) start_ = turnsAt(slice.sum);
    const float step = shortest(turnsAt(slice.sum) - start_ - turned);
    if (std::abs(step) > options_.longest_step) return false;
    turned += step;
    way += std::abs(step);
    knots_.push_back({static_cast<float>(k) + 0.5F, turned});
  }
  sign_ = turned < 0.0F ? -1.0F : 1.0F;
  return way > 0.0F && way <= (1.0F + options_.most_detour) * std::abs(turned);
}

/// The cloud begins before the middle of its first slice, and ends behind that of its last one.
void Spin::reachToTheEnds() {
  const float per_slice = sign_ * knots_.back().turns / (knots_.back().place - knots_.front().place);
  const float before = per_slice * knots_.front().place;
  start_ = shortest(start_ - sign_ * before);
  for (Knot& knot : knots_) knot.turns = before + sign_ * knot.turns;
  turned_ = per_slice * static_cast<float>(options_.slices);
}

/// Whether echoes that follow one another lie side by side, in one direction, several times around; and where.
bool Spin::isRingByRing(const std::vector<Eigen::Vector3f>& echoes) {
  slices_.assign(options_.slices, {});
  float before = 0.0F, slope_before = 0.0F, way = 0.0F;
  int forth = 0, back = 0;
  bool is_first = true;
  for (const Eigen::Vector3f& echo : echoes) {
    const Eigen::Vector2f direction = directionOf(echo);
    if (direction.isZero(0.0F)) continue;
    const float azimuth = turnsAt(direction), slope = echo.z() / echo.head<2>().norm();
    const float step = is_first ? 0.0F : shortest(azimuth - before);
    const bool is_small = std::abs(step) < options_.small_step;
    forth += is_small && step > 0.0F ? 1 : 0;
    back += is_small && step < 0.0F ? 1 : 0;
    way += step;
    if (is_first || std::abs(slope - slope_before) > options_.least_ring_gap) beginRing(azimuth, direction);
    before = azimuth;
    slope_before = slope;
    is_first = false;
  }
  sign_ = back > forth ? -1.0F : 1.0F;
  turned_ = 1.0F;
  const auto most = static_cast<float>(std::max(forth, back)), all = static_cast<float>(forth + back);
  const float rings = sign_ * way;
  return rings >= options_.least_rings && most >= options_.least_steady * all && findBegin(rings);
}

/// At the edges of things the slope changes, too, but everywhere.
void Spin::beginRing(float azimuth, const Eigen::Vector2f& direction) {
  // Straight ahead and behind, where many begin, is the middle of a slice.
  const auto slice = static_cast<std::size_t>((azimuth + 0.5F) * static_cast<float>(options_.slices) + 0.5F);
  Directions& begun = slices_[slice % options_.slices];
  begun.sum += direction;
  ++begun.count;
}

bool Spin::findBegin(float rings) {
  const auto by_count = [](const Directions& a, const Directions& b) { return a.count < b.count; };
  const Directions& most = *std::max_element(slices_.begin(), slices_.end(), by_count);
  start_ = turnsAt(most.sum);
  return static_cast<float>(most.count) >= options_.least_begun * rings;
}

void Spin::turnsOf(const std::vector<Eigen::Vector3f>& echoes, std::vector<float>& turns) const {
  turns.resize(echoes.size());
  if (order_ == Order::kRings) {
    for (std::size_t i = 0; i < echoes.size(); ++i) {
      const float around = sign_ * (turnsAt(echoes[i].head<2>()) - start_);
      turns[i] = std::isfinite(around) ? around - std::floor(around) : 0.0F;
    }
    return;
  }
  std::size_t k = 0;  // the knot before
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    const float place = placeOf(i);
    if (place < knots_[k].place) k = 0;
    while (k + 2 < knots_.size() && place > knots_[k + 1].place) ++k;
    const Knot &from = knots_[k], &to = knots_[k + 1];
    turns[i] = from.turns + (place - from.place) / (to.place - from.place) * (to.turns - from.turns);
  }
}

}  // namespace donex
