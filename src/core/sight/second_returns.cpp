#include "core/sight/second_returns.h"

#include <algorithm>
#include <cmath>

namespace donex {
namespace {

constexpr float kCell = 2e-3F;  // of directions [rad]: many times what is the same, and less than beams lie apart
constexpr float kNoDirection = 1e-3F;      // [m]: nearer there is no direction
constexpr std::size_t kMostAround = 4096;  // echoes that are asked at a time: room for them is set aside at once

/// Cells are counted from -1 on, with a margin, so that cutting off is rounding down.
Eigen::Array3i cellOf(const Eigen::Array3f& direction) { return ((direction + 1.01F) / kCell).cast<int>(); }

bool hasDirection(const Eigen::Vector3f& ray) {
  return ray.allFinite() && ray.squaredNorm() > kNoDirection * kNoDirection;
}

}  // namespace

const std::vector<std::uint8_t>& SecondReturns::find(const std::vector<Eigen::Vector3f>& echoes,
                                                     const Eigen::Vector3f& sensor) {
  sensor_ = sensor;
  found_.clear();
  if (!has_pairs_ && !tellsPairs(echoes)) return found_;
  search(echoes);
  const auto pairs = static_cast<double>(std::count(found_.begin(), found_.end(), 1));
  const bool has_hardly_any = 2.0 * pairs < 0.5 * options_.least_share * static_cast<double>(echoes.size());
  scans_without_ = has_hardly_any ? scans_without_ + 1 : 0;
  has_pairs_ = scans_without_ < options_.rest;
  return found_;
}

bool SecondReturns::tellsPairs(const std::vector<Eigen::Vector3f>& echoes) {
  const bool rests = asked_scans_ >= options_.first_scans && ++resting_ < options_.rest;
  if (rests) return false;
  for (int i = 0; i < options_.places; ++i) askAround(echoes);
  if (asked_ < options_.least_asked) return false;  // small clouds: the next one adds to these
  const double share = static_cast<double>(paired_) / static_cast<double>(asked_);
  asked_ = paired_ = 0;
  ++asked_scans_;
  resting_ = scans_without_ = 0;
  return share >= options_.least_share;
}

/// Around a direction of the scan, another one each time.
void SecondReturns::askAround(const std::vector<Eigen::Vector3f>& echoes) {
  constexpr std::size_t kOnward = 40503;  // echoes: by and by everywhere, whatever the scan's order
  if (echoes.empty()) return;
  place_ = (place_ + kOnward) % echoes.size();
  const Eigen::Vector3f ray = echoes[place_] - sensor_;
  if (!hasDirection(ray)) return;
  const Eigen::Vector3f middle = ray.normalized();
  const float cosine = std::cos(options_.asked_around);
  around_.clear();
  around_.reserve(kMostAround);
  for (const Eigen::Vector3f& echo : echoes) {
    if (around_.size() == kMostAround) break;
    const Eigen::Vector3f other = echo - sensor_;
    const float along = other.dot(middle);  // NaN is no more than anything
    if (along > 0.0F && along * along > cosine * cosine * other.squaredNorm()) around_.push_back(echo);
  }
  search(around_);
  asked_ += around_.size();
  paired_ += 2 * static_cast<std::size_t>(std::count(found_.begin(), found_.end(), 1));
  found_.clear();
}

/// Each echo is compared with those before it.
void SecondReturns::search(const std::vector<Eigen::Vector3f>& echoes) {
  constexpr std::size_t kAhead = 16;  // entries; long enough for memory to answer
  enter(echoes);
  found_.assign(echoes.size(), 0);
  for (std::size_t k = 0; k < entries_.size(); ++k) {
    if (k + kAhead < entries_.size()) __builtin_prefetch(&heads_[entries_[k + kAhead].link]);
    Entry& entry = entries_[k];
    visitSameDirection(entry.direction, [&](const Entry& other) {
      if (entry.range - other.range > options_.least_behind) found_[entry.echo] = 1;
      if (other.range - entry.range > options_.least_behind) found_[other.echo] = 1;
    });
    std::uint32_t& head = heads_[entry.link];
    entry.link = head;
    head = static_cast<std::uint32_t>(k + 1);
  }
}

void SecondReturns::enter(const std::vector<Eigen::Vector3f>& echoes) {
  std::size_t slots = 1024;
  while (slots < 2 * echoes.size()) slots *= 2;
  heads_.reserve(4 * kMostAround);
  heads_.assign(slots, 0);
  entries_.clear();
  entries_.reserve(std::max(kMostAround, echoes.size()));
  found_.reserve(entries_.capacity());
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    const Eigen::Vector3f ray = echoes[i] - sensor_;
    if (!hasDirection(ray)) continue;
    const float range = ray.norm();
    const Eigen::Vector3f direction = ray / range;
    entries_.push_back({direction, range, static_cast<std::uint32_t>(i), slotOf(cellOf(direction))});
  }
}

/// All entries that are in a chain and within `same_direction`: in the cell of the direction, and in those beside it
/// where it lies at a border.
template <class Visit>
void SecondReturns::visitSameDirection(const Eigen::Vector3f& direction, const Visit& visit) const {
  const Eigen::Array3i from = cellOf(direction.array() - options_.same_direction);
  const Eigen::Array3i to = cellOf(direction.array() + options_.same_direction);
  const float most = options_.same_direction * options_.same_direction;
  for (int x = from.x(); x <= to.x(); ++x) {
    for (int y = from.y(); y <= to.y(); ++y) {
      for (int z = from.z(); z <= to.z(); ++z) {
        for (std::uint32_t k = heads_[slotOf({x, y, z})]; k != 0; k = entries_[k - 1].link) {
          if ((entries_[k - 1].direction - direction).squaredNorm() <= most) visit(entries_[k - 1]);
        }
      }
    }
  }
}

std::uint32_t SecondReturns::slotOf(const Eigen::Array3i& cell) const {
  const auto part = [](int index, std::uint32_t prime) { return static_cast<std::uint32_t>(index) * prime; };
  const std::uint32_t hash = part(cell.x(), 73856093U) ^ part(cell.y(), 19349663U) ^ part(cell.z(), 83492791U);
  return (hash ^ (hash >> 15U)) & static_cast<std::uint32_t>(heads_.size() - 1);
}

void SecondReturns::reset() {
  has_pairs_ = false;
  asked_scans_ = resting_ = scans_without_ = 0;
  asked_ = paired_ = place_ = 0;
}

std::size_t SecondReturns::memoryBytes() const {
  return heads_.capacity() * sizeof(std::uint32_t) + entries_.capacity() * sizeof(Entry) + found_.capacity() +
         around_.capacity() * sizeof(Eigen::Vector3f);
}

}  // namespace donex
