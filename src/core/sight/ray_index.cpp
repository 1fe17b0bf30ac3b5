#include "core/sight/ray_index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/grid/brick_layout.h"
#include "core/grid/simd.h"

namespace donex {
namespace {

constexpr int kAcross = 512;  // bins across one side of the prism
constexpr int kUp = 64;       // bins of height
constexpr int kBins = 4 * kAcross * kUp;
constexpr int kLanes = 8;             // rays that are looked at together
constexpr float kStraightUp = 1e9F;   // tangent of straight up, and beyond any other
constexpr float kSteepestRow = 1.0F;  // tangent of the elevation where the outermost rows collect all the rest

// Single precision errs by less than 1e-6 of the numbers compared.
constexpr float kMargin = 4e-6F;
constexpr float kDepthMargin = 1e-6F;
constexpr int kEdge = GridWindow::kBrick;
using Lanes = Eigen::Map<const Eigen::Array<float, kLanes, 1>>;

struct Projected {
  float *across, *up, *depth;
  std::uint32_t* bin;
};

/// Echoes without a direction (invalid, or in the sensor itself) get the bin behind the last, and no NaN: what a
/// library's minimum makes of that differs between libraries, and between their versions.
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
    to.across[i] = has_direction ? across : 0.0F;
    to.up[i] = has_direction ? up : 0.0F;
    to.depth[i] = has_direction ? depth : -1.0F;
    to.bin[i] = static_cast<std::uint32_t>(has_direction ? bin : kBins);
  }
}

/// A vector as side `side` sees it: depth along the side's axis, then across, then up.
Eigen::Vector3f onSide(int side, const Eigen::Vector3f& p) {
  switch (side) {
    case 0: return {p.x(), p.y(), p.z()};
    case 1: return {p.y(), -p.x(), p.z()};
    case 2: return {-p.x(), -p.y(), p.z()};
    default: return {-p.y(), p.x(), p.z()};
  }
}

int sideOf(const Eigen::Vector3f& p) {
  if (std::abs(p.x()) >= std::abs(p.y())) return p.x() >= 0.0F ? 0 : 2;
  return p.y() >= 0.0F ? 1 : 3;
}

int acrossBin(float across) { return std::clamp(static_cast<int>((across + 1.0F) * (0.5F * kAcross)), 0, kAcross - 1); }

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
  float low = kSteepestRow, high = -kSteepestRow;
  const std::size_t with_direction = bins_of_part_.front().back().first;
  if (with_direction != 0) {
    const Eigen::Map<const Eigen::ArrayXf> ups(rays_.up.data(), static_cast<Eigen::Index>(with_direction));
    low = std::min(low, ups.minCoeff());
    high = std::max(high, ups.maxCoeff());
  }
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

struct RayIndex::Shadow {
  int side;
  Eigen::Vector3f near, far;      ///< the box on that side: depth, across, up [voxels]
  float near_depth;               ///< a ray must be as deep to touch the box [voxels]
  bool is_ahead;                  ///< the box begins well ahead of the sensor: what single precision says can be sure
  float across_low, across_high;  ///< tangents
  float up_low, up_high;
  float across_margin, up_margin;  ///< tangents
  float margin;                    ///< [voxels]
  int first_column, last_column, first_row, last_row;
};

struct RayIndex::BrickAhead {
  int side;
  Eigen::Vector3f low;                     ///< its lowest corner on that side [voxels]
  std::array<float, kEdge + 1> per_depth;  ///< one over the depths of the faces between its voxels
};

int RayIndex::rowOf(float up) const {
  return static_cast<int>(std::min(std::max((up - rows_.low) * rows_.per_up, 0.0F), kUp - 1.0F));
}

inline const RayIndex::Bin* RayIndex::stripOf(int side, int column) const {
  return bins_of_part_.front().data() + static_cast<std::ptrdiff_t>(side * kAcross + column) * kUp;
}

/// Margins and bins, from the bounds.
inline void RayIndex::findBins(Shadow& shadow) const {
  shadow.across_margin = kMargin * (1.0F + std::max(std::abs(shadow.across_low), std::abs(shadow.across_high)));
  shadow.up_margin = kMargin * (1.0F + std::max(std::abs(shadow.up_low), std::abs(shadow.up_high)));
  shadow.margin = 2.0F * kMargin *
                  (shadow.far.x() + std::max(std::abs(shadow.near.y()), std::abs(shadow.far.y())) +
                   std::max(std::abs(shadow.near.z()), std::abs(shadow.far.z())));
  shadow.first_column = acrossBin(std::max(shadow.across_low - shadow.across_margin, -1.0F));
  shadow.last_column = acrossBin(std::min(shadow.across_high + shadow.across_margin, 1.0F));
  shadow.first_row = rowOf(shadow.up_low - shadow.up_margin);
  shadow.last_row = rowOf(shadow.up_high + shadow.up_margin);
}

/// The box on one side of the prism; false where no line of sight of that side can touch it.
bool RayIndex::shadowOn(int side, const Eigen::Vector3f& low, const Eigen::Vector3f& high, Shadow& shadow) const {
  const Eigen::Vector3f a = onSide(side, low), b = onSide(side, high);
  shadow.near = a.cwiseMin(b);
  shadow.far = a.cwiseMax(b);
  const Eigen::Vector3f &near = shadow.near, &far = shadow.far;
  const float least_across = std::max({near.y(), -far.y(), 0.0F});
  const bool on_this_side = far.x() >= 0.0F && least_across <= far.x() * (1.0F + kMargin) + kMargin;
  if (!on_this_side) return false;
  shadow.side = side;
  shadow.near_depth = std::max({near.x(), least_across, 0.0F}) * (1.0F - kDepthMargin);
  shadow.is_ahead = near.x() >= 1.0F;
  // Directions spread most at the near face, unless the box does not reach the axis on that flank.
  const bool at_sensor = shadow.near_depth <= kMargin;
  const float per_near = at_sensor ? 0.0F : 1.0F / std::max(near.x(), shadow.near_depth);
  const float per_far = 1.0F / std::max(far.x(), kMargin);
  shadow.across_low = at_sensor ? -1.0F : near.y() * (near.y() < 0.0F ? per_near : per_far);
  shadow.across_high = at_sensor ? 1.0F : far.y() * (far.y() > 0.0F ? per_near : per_far);
  shadow.up_low = near.z() * (near.z() < 0.0F ? per_near : per_far);
  shadow.up_high = far.z() * (far.z() > 0.0F ? per_near : per_far);
  findBins(shadow);
  // A box around the sensor's axis: lines of sight through it may be as steep as they like, on the sensor's height even
  // in both directions.
  if (at_sensor && near.z() <= kMargin) shadow.up_low = -kStraightUp, shadow.first_row = 0;
  if (at_sensor && far.z() >= -kMargin) shadow.up_high = kStraightUp, shadow.last_row = kUp - 1;
  return true;
}

/// `edge` voxels of the brick along each axis, from its voxel `low` (on the brick's side) upwards.
inline RayIndex::Shadow RayIndex::shadowOf(const BrickAhead& brick, const Index3& low, int edge) {
  Shadow shadow;
  shadow.side = brick.side;
  shadow.near = brick.low + low.cast<float>();
  shadow.far = shadow.near.array() + static_cast<float>(edge);
  shadow.near_depth = shadow.near.x() * (1.0F - kDepthMargin);
  shadow.is_ahead = true;
  const auto near_face = static_cast<std::size_t>(low.x()), far_face = near_face + static_cast<std::size_t>(edge);
  const float per_near = brick.per_depth[near_face], per_far = brick.per_depth[far_face];
  shadow.across_low = shadow.near.y() * (shadow.near.y() < 0.0F ? per_near : per_far);
  shadow.across_high = shadow.far.y() * (shadow.far.y() > 0.0F ? per_near : per_far);
  shadow.up_low = shadow.near.z() * (shadow.near.z() < 0.0F ? per_near : per_far);
  shadow.up_high = shadow.far.z() * (shadow.far.z() > 0.0F ? per_near : per_far);
  return shadow;
}

/// True where a bin of the box has a line of sight that is deep enough to touch it.
inline bool RayIndex::anyRayReaches(const Shadow& shadow) const {
  for (int column = shadow.first_column; column <= shadow.last_column; ++column) {
    const Bin* bin = stripOf(shadow.side, column);
    for (int row = shadow.first_row; row <= shadow.last_row; ++row) {
      if (bin[row].farthest >= shadow.near_depth) return true;
    }
  }
  return false;
}

/// Whether the ray crosses the shadow's box, where single precision can tell. Three intervals along the ray (inside the
/// box in depth, across, up) have a point in common when each two have. In depth and each of the others they have one
/// where the direction lies within the shadow.
inline RayIndex::Crossing RayIndex::judge(std::uint32_t ray, const Shadow& box) const {
  const float ray_across = rays_.across[ray], ray_up = rays_.up[ray], ray_depth = rays_.depth[ray];
  const float in_across = std::min(ray_across - box.across_low, box.across_high - ray_across);
  const float in_up = std::min(ray_up - box.up_low, box.up_high - ray_up);
  if (in_across < -box.across_margin || in_up < -box.up_margin || ray_depth < box.near_depth) return Crossing::kNo;
  if (!box.is_ahead) return Crossing::kUnsure;
  // Across and up as if both slopes were positive.
  const float across = std::abs(ray_across), up = std::abs(ray_up);
  const float enter_across = ray_across >= 0.0F ? box.near.y() : -box.far.y();
  const float leave_across = ray_across >= 0.0F ? box.far.y() : -box.near.y();
  const float enter_up = ray_up >= 0.0F ? box.near.z() : -box.far.z();
  const float leave_up = ray_up >= 0.0F ? box.far.z() : -box.near.z();
  const float in_both = std::min(leave_up * across - enter_across * up, leave_across * up - enter_up * across);
  const float both_margin = box.margin * (across + up);
  const float end_across = across * ray_depth, end_up = up * ray_depth;
  const bool ends_before = end_across < enter_across - box.margin || end_up < enter_up - box.margin;
  if (in_both < -both_margin || ends_before) return Crossing::kNo;
  const bool passes = in_across > box.across_margin && in_up > box.up_margin && in_both > both_margin;
  const bool ends_behind =
      ray_depth > box.far.x() + box.margin || end_across > leave_across + box.margin || end_up > leave_up + box.margin;
  return passes && ends_behind ? Crossing::kYes : Crossing::kUnsure;
}

bool RayIndex::crosses(std::uint32_t ray, const Index3& voxel) const {
  return LineOfSight(placement_.origin, placement_.toWindow((*echoes_)[echo_of_ray_[ray]])).crosses(voxel);
}

inline bool RayIndex::anyRayCrosses(const Shadow& shadow, const Index3& voxel) const {
  const float across_low = shadow.across_low - shadow.across_margin;
  const float across_high = shadow.across_high + shadow.across_margin;
  const float up_low = shadow.up_low - shadow.up_margin, up_high = shadow.up_high + shadow.up_margin;
  for (int column = shadow.first_column; column <= shadow.last_column; ++column) {
    const Bin* bin = stripOf(shadow.side, column);
    const std::uint32_t end = bin[shadow.last_row + 1].first;
    for (std::uint32_t first = bin[shadow.first_row].first; first < end; first += kLanes) {
      const Lanes across(&rays_.across[first]), up(&rays_.up[first]), depth(&rays_.depth[first]);
      const Eigen::Array<float, kLanes, 1> slack = (across - across_low)
                                                       .min(across_high - across)
                                                       .min((up - up_low).min(up_high - up))
                                                       .min(depth - shadow.near_depth);
      if (slack.maxCoeff() < 0.0F) continue;
      for (std::uint32_t ray = first; ray < std::min(first + kLanes, end); ++ray) {
        if (slack[ray - first] < 0.0F) continue;
        const Crossing crossing = judge(ray, shadow);
        if (crossing == Crossing::kYes || (crossing == Crossing::kUnsure && crosses(ray, voxel))) return true;
      }
    }
  }
  return false;
}

bool RayIndex::seesThrough(const Index3& voxel) const {
  const Eigen::Vector3f low = voxel.cast<float>() - placement_.origin;
  const Eigen::Vector3f high = low + Eigen::Vector3f::Ones();
  Shadow shadow;
  for (int side = 0; side < kSides; ++side) {
    if (shadowOn(side, low, high, shadow) && anyRayCrosses(shadow, voxel)) return true;
  }
  return false;
}

bool RayIndex::maySeeThrough(const Index3& corner, int edge) const {
  const Eigen::Vector3f low = corner.cast<float>() - placement_.origin;
  const Eigen::Vector3f high = low + Eigen::Vector3f::Constant(static_cast<float>(edge));
  Shadow shadow;
  for (int side = 0; side < kSides; ++side) {
    if (shadowOn(side, low, high, shadow) && anyRayReaches(shadow)) return true;
  }
  return false;
}

std::uint64_t RayIndex::seenThrough(std::uint64_t candidates, const Index3& corner) const {
  const Eigen::Vector3f low = corner.cast<float>() - placement_.origin;
  const Eigen::Vector3f high = low.array() + static_cast<float>(kEdge);
  const int side = sideOf(0.5F * (low + high));
  const Eigen::Vector3f a = onSide(side, low), b = onSide(side, high);
  BrickAhead brick;
  brick.side = side;
  brick.low = a.cwiseMin(b);
  const float widest = std::max(std::abs(a.y()), std::abs(b.y()));
  if (brick.low.x() >= 1.0F && widest < brick.low.x()) return seenThrough(candidates, brick, corner);
  if (!maySeeThrough(corner, kEdge)) return 0;
  std::uint64_t seen = 0;
  for (; candidates != 0; candidates &= candidates - 1) {
    const int bit = __builtin_ctzll(candidates);
    if (seesThrough(BrickLayout::voxelOfBit(corner, bit))) seen |= std::uint64_t{1} << bit;
  }
  return seen;
}

std::uint64_t RayIndex::seenThrough(std::uint64_t candidates, const BrickAhead& at, const Index3& corner) const {
  BrickAhead brick = at;
  for (int i = 0; i <= kEdge; ++i) {
    brick.per_depth[static_cast<std::size_t>(i)] = 1.0F / (brick.low.x() + static_cast<float>(i));
  }
  Shadow shadow = shadowOf(brick, Index3::Zero(), kEdge);
  findBins(shadow);
  if (!anyRayReaches(shadow)) return 0;
  std::uint64_t seen = 0;
  for (; candidates != 0; candidates &= candidates - 1) {
    const int bit = __builtin_ctzll(candidates);
    const int x = bit & 3, y = bit >> 2 & 3, z = bit >> 4;
    Index3 low;
    switch (brick.side) {
      case 0: low = {x, y, z}; break;
      case 1: low = {y, 3 - x, z}; break;
      case 2: low = {3 - x, 3 - y, z}; break;
      default: low = {3 - y, x, z}; break;
    }
    shadow = shadowOf(brick, low, 1);
    findBins(shadow);
    if (anyRayCrosses(shadow, BrickLayout::voxelOfBit(corner, bit))) seen |= std::uint64_t{1} << bit;
  }
  return seen;
}

}  // namespace donex
