#include "core/sight/ray_index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/grid/simd.h"
#include "core/sight/ray_bins.h"

namespace donex {
namespace {

constexpr float kSteepestRow = 1.0F;  // tangent of the elevation where the outermost rows collect all the rest

struct Projected {
  float *across, *up, *depth;
  std::uint32_t* bin;
};

/// Echoes without a direction (invalid, or in the sensor itself) get the bin behind the last.
DONEX_WIDE_LOOPS void project(const Eigen::Vector3f& origin, float row_low, float per_up, const EchoBlock& block,
                              const Projected& to) {
  const float ox = origin.x(), oy = origin.y(), oz = origin.z();
  for (int i = 0; i < EchoBlock::kSize; ++i) {
    const float dx = block.x[i] - ox, dy = block.y[i] - oy, dz = block.z[i] - oz;
    const float ax = std::abs(dx), ay = std::abs(dy);
    const bool along_x = ax >= ay;
    const float depth = along_x ? ax : ay;
    const float ahead = along_x ? dx : dy;
    const float beside = along_x ? dy : -dx;
    const bool is_level = depth > 0.0F;
    const float per_depth = 1.0F / (is_level ? depth : 1.0F);
    // Straight up and down belong to the first side's outermost rows.
    const float across = (ahead >= 0.0F ? beside : -beside) * per_depth;
    const float up = is_level ? dz * per_depth : (dz > 0.0F ? kStraightUp : -kStraightUp);
    const int side = (along_x ? 0 : 1) + (ahead >= 0.0F ? 0 : 2);
    const float column = std::min(std::max((across + 1.0F) * (0.5F * kAcross), 0.0F), kAcross - 1.0F);
    const float row = std::min(std::max((up - row_low) * per_up, 0.0F), kUp - 1.0F);
    const bool has_direction =
        static_cast<int>(depth > 0.0F) | static_cast<int>(dz > 0.0F) | static_cast<int>(dz < 0.0F);
    // NaN passes through min and max as their first argument: converted only where there is a direction.
    const int bin = (side * kAcross + static_cast<int>(has_direction ? column : 0.0F)) * kUp +
                    static_cast<int>(has_direction ? row : 0.0F);
    to.across[i] = across;
    to.up[i] = up;
    to.depth[i] = depth;
    to.bin[i] = static_cast<std::uint32_t>(has_direction ? bin : kBins);
  }
}

}  // namespace

void RayIndex::Rays::resize(std::size_t rays) {
  across.resize(rays);
  up.resize(rays);
  depth.resize(rays);
}

void RayIndex::begin(const Placement& placement, const std::vector<Eigen::Vector3f>& echoes, std::size_t parts) {
  placement_ = placement;
  echoes_ = &echoes;
  rows_ = next_rows_;
  const std::size_t padded = blocksOf(echoes.size()) * EchoBlock::kSize;
  by_echo_.resize(padded);
  bin_of_echo_.resize(padded);
  bins_of_part_.resize(parts);
  // The other parts' bins were emptied when they were sorted.
  bins_of_part_.front().assign(kBins + 1, kEmpty);
  for (std::vector<Bin>& bins : bins_of_part_) bins.resize(kBins + 1, kEmpty);
}

void RayIndex::add(std::size_t part, std::size_t first, const EchoBlock& block) {
  const Projected to{by_echo_.across.data() + first, by_echo_.up.data() + first, by_echo_.depth.data() + first,
                     bin_of_echo_.data() + first};
  project(placement_.origin, rows_.low, rows_.per_up, block, to);
  Bin* bins = bins_of_part_[part].data();
  for (int i = 0; i < EchoBlock::kSize; ++i) {
    Bin& bin = bins[to.bin[i]];
    ++bin.first;
    bin.farthest = std::max(bin.farthest, to.depth[i]);
  }
}

void RayIndex::finish(const Workers& workers) {
  // Counts become ends; filling backwards turns the ends into starts.
  std::uint32_t end = 0;
  for (std::size_t i = 0; i <= kBins; ++i) {
    for (std::vector<Bin>& bins : bins_of_part_) {
      bins[i].first = end += bins[i].first;
      bins_of_part_.front()[i].farthest = std::max(bins_of_part_.front()[i].farthest, bins[i].farthest);
    }
  }
  rays_.resize(end + kLanes);  // whole registers are read
  echo_of_ray_.resize(end);
  const auto sort_part = [this](std::size_t part) { sortPart(part); };
  workers.each(bins_of_part_.size(), sort_part);
  next_rows_ = rowsOfScan();
}

void RayIndex::sortPart(std::size_t part) {
  const std::size_t parts = bins_of_part_.size(), blocks = bin_of_echo_.size() / EchoBlock::kSize;
  const std::size_t first = firstBlockOf(part, parts, blocks) * EchoBlock::kSize;
  Bin* bins = bins_of_part_[part].data();
  for (std::size_t i = firstBlockOf(part + 1, parts, blocks) * EchoBlock::kSize; i-- > first;) {
    const std::uint32_t ray = --bins[bin_of_echo_[i]].first;
    rays_.across[ray] = by_echo_.across[i];
    rays_.up[ray] = by_echo_.up[i];
    rays_.depth[ray] = by_echo_.depth[i];
    echo_of_ray_[ray] = static_cast<std::uint32_t>(i);
  }
  if (part != 0) std::fill_n(bins, kBins + 1, kEmpty);
}

RayIndex::Rows RayIndex::rowsOfScan() const {
  // Behind them are those without a direction, which may be NaN. Lane by lane: what a library's minimum makes of NaN,
  // and in which order it looks, does not matter then.
  const std::size_t with_direction = bins_of_part_.front().back().first;
  std::array<float, kLanes> lows, highs;
  lows.fill(kSteepestRow);
  highs.fill(-kSteepestRow);
  for (std::size_t first = 0; first < with_direction; first += kLanes) {
    const std::size_t lanes = std::min(with_direction - first, lows.size());
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      lows[lane] = std::min(lows[lane], rays_.up[first + lane]);
      highs[lane] = std::max(highs[lane], rays_.up[first + lane]);
    }
  }
  float low = *std::min_element(lows.begin(), lows.end()), high = *std::max_element(highs.begin(), highs.end());
  low = std::max(low, -kSteepestRow);
  high = std::min(high, kSteepestRow);
  constexpr float kLeastSpan = 0.1F;
  return low <= high ? Rows{low, kUp / std::max(high - low, kLeastSpan)} : Rows{};
}

double RayIndex::bytesFor(double echoes, int parts) {
  constexpr double kAnEcho = 2 * (3 * sizeof(float) + sizeof(std::uint32_t));
  return kAnEcho * echoes + static_cast<double>(parts) * static_cast<double>(kBins * sizeof(Bin));
}

std::size_t RayIndex::memoryBytes() const {
  const auto bytes = [](const Rays& rays) { return 3 * rays.across.capacity() * sizeof(float); };
  return bytes(by_echo_) + bytes(rays_) + (bin_of_echo_.capacity() + echo_of_ray_.capacity()) * sizeof(std::uint32_t) +
         bins_of_part_.size() * (kBins + 1) * sizeof(Bin);
}

}  // namespace donex
