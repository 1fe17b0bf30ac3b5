#include "donex/core/grid_3d.h"

#include <algorithm>

namespace donex {
namespace {

constexpr std::uint64_t kAll = ~std::uint64_t{0};
constexpr int kAhead = 12;  // bricks are asked of memory so many echoes before they are needed

constexpr std::size_t kBlocksAtOnce = 16;  // of the index, by one thread

std::uint64_t maskOf(std::uint32_t bit) { return std::uint64_t{1} << bit; }

}  // namespace

Grid3d::Grid3d(const Config& config)
    : window_(config), layout_(window_.extent()), bricks_(layout_.slots() + 1), workers_(config.threads) {
  bricks_.back().remembered = kAll;  // what is outside is never new
  used_.reserve(layout_.slots() / kSlotsAUsedBrick);
  layout_.scrollTo(window_.minIndex());
}

void Grid3d::shift(const Eigen::Isometry3d& odom_from_base) {
  if (window_.compensation() == Compensation::kScroll) {
    scroll(odom_from_base);
  } else {
    resample(odom_from_base);
  }
}

void Grid3d::scroll(const Eigen::Isometry3d& odom_from_base) {
  const Index3 before = window_.minIndex();
  window_.moveTo(odom_from_base);
  if (window_.minIndex() == before) return;
  const auto leaves = [&](const Used& used) {
    const bool stays = window_.contains(used.corner - window_.minIndex());
    if (!stays) bricks_[used.slot] = Brick{};
    return !stays;
  };
  used_.erase(std::remove_if(used_.begin(), used_.end(), leaves), used_.end());
  layout_.scrollTo(window_.minIndex());
}

void Grid3d::resample(const Eigen::Isometry3d& odom_from_base) {
  window_.moveTo(odom_from_base);
  const Eigen::Isometry3d grid_from_odom = window_.odomFromGrid().inverse();
  clearBricks();
  std::size_t kept = 0;
  for (Content& content : contents_) {
    const Eigen::Vector3d in_grid = grid_from_odom * content.in_odom / window_.voxelSize();
    const Index3 voxel = in_grid.array().floor().cast<int>().matrix() - window_.minIndex();
    if (!window_.contains(voxel)) continue;
    content.at = layout_.locate(voxel);
    Brick& brick = brickAt(content.at.slot, voxel);
    // Two contents in one voxel: the older stays, so a content never moves by another's residual.
    if ((brick.remembered & maskOf(content.at.bit)) != 0) continue;
    brick.remembered |= maskOf(content.at.bit);
    contents_[kept++] = content;
  }
  contents_.resize(kept);
}

/// The brick of a voxel of the window, listed as used.
Grid3d::Brick& Grid3d::brickAt(std::uint32_t slot, const Index3& in_window) {
  Brick& brick = bricks_[slot];
  const bool is_empty = (brick.remembered | brick.hit) == 0;
  if (is_empty) used_.push_back({slot, (in_window + window_.minIndex()).unaryExpr([](int i) { return i & ~3; })});
  return brick;
}

void Grid3d::take(const Scan& scan, EchoLabels& labels) {
  const Placement placement = window_.placementOf(scan);
  rays_.begin(placement, scan.echoes);
  const auto add = [&](std::size_t first, const EchoBlock& block) { rays_.add(first, block); };
  if (workers_.threads() == 1) {
    hit(scan, placement, labels, add);
    rays_.finish();
  } else {
    // Hits and rays need nothing of each other but the echoes' places, which are quicker computed twice than handed
    // over.
    const std::size_t blocks = blocksOf(scan.echoes.size());
    const auto some = [&](std::size_t i) {
      forEachBlock(placement, scan.echoes, i * kBlocksAtOnce, std::min((i + 1) * kBlocksAtOnce, blocks), add);
    };
    const auto index = [&] {
      workers_.each((blocks + kBlocksAtOnce - 1) / kBlocksAtOnce, some);
      rays_.finish();
    };
    workers_.both([&] { hit(scan, placement, labels, [](std::size_t, const EchoBlock&) {}); }, index);
  }
  remember([&](std::uint64_t candidates, const Index3& corner) { return rays_.seenThrough(candidates, corner); });
}

void Grid3d::beginHits(std::size_t echoes, EchoLabels& labels) {
  labels.resize(echoes);
  hit_voxels_.clear();
  no_echoes_.clear();
  no_echoes_.reserve(echoes);
  new_count_ = 0;
  if (new_voxels_.size() <= echoes) new_voxels_.resize(echoes + 1);
}

void Grid3d::hit(std::size_t first, const EchoBlock& block, EchoLabels& labels) {
  block.appendNoEchoes(first, no_echoes_);
  const bool resamples = window_.compensation() == Compensation::kResample;
  resamples ? hitInOrder<true>(first, block, labels) : hitInOrder<false>(first, block, labels);
}

template <bool keep_order>
void Grid3d::hitInOrder(std::size_t first, const EchoBlock& block, EchoLabels& labels) {
  BlockSlots at;
  layout_.locate(block, at);
  std::uint8_t* dynamic = labels.dynamic.data() + first;
  int new_echoes[EchoBlock::kSize + 1], new_count = 0;
  for (int i = 0; i < block.count; ++i) {
    if (i + kAhead < EchoBlock::kSize) __builtin_prefetch(&bricks_[at.slot[i + kAhead]], 1);
    Brick& brick = bricks_[at.slot[i]];
    if ((brick.remembered | brick.hit) == 0) brickAt(at.slot[i], block.voxel(i));
    const std::uint64_t mask = maskOf(at.bit[i]);
    const bool is_new = (brick.remembered & mask) == 0;
    if (keep_order && block.inside[i] != 0 && (brick.hit & mask) == 0) hit_voxels_.push_back(block.voxel(i));
    brick.hit |= mask;
    dynamic[i] = is_new ? 1 : 0;
    new_echoes[new_count] = i;
    new_count += is_new ? 1 : 0;  // written in any case: no branch to guess
  }
  std::copy_n(block.observed, block.count, labels.observed.data() + first);
  for (int i = 0; i < new_count; ++i) new_voxels_[new_count_++] = block.voxel(new_echoes[i]);
}

/// A hit voxel starts anew from its centre; one in the shadow keeps the residual it carries.
void Grid3d::forgetHitContents() {
  const auto is_hit = [&](const Content& content) {
    return (bricks_[content.at.slot].hit & maskOf(content.at.bit)) != 0;
  };
  contents_.erase(std::remove_if(contents_.begin(), contents_.end(), is_hit), contents_.end());
}

void Grid3d::rememberContents() {
  const auto is_forgotten = [&](const Content& content) {
    return (bricks_[content.at.slot].remembered & maskOf(content.at.bit)) == 0;
  };
  contents_.erase(std::remove_if(contents_.begin(), contents_.end(), is_forgotten), contents_.end());
  for (const Index3& voxel : hit_voxels_) {
    contents_.push_back({window_.odomFromGrid() * window_.indexToCenter(voxel), layout_.locate(voxel)});
  }
}

void Grid3d::clearBricks() {
  for (const Used& used : used_) bricks_[used.slot] = Brick{};
  used_.clear();
}

void Grid3d::reset() {
  clearBricks();
  rays_.reset();
  new_count_ = 0;
  no_echoes_.clear();
  contents_.clear();
  hit_voxels_.clear();
}

std::vector<Index3> Grid3d::remembered() const {
  std::vector<Index3> voxels;
  for (const Used& used : used_) {
    for (std::uint64_t word = bricks_[used.slot].remembered; word != 0; word &= word - 1) {
      voxels.push_back(BrickLayout::voxelOfBit(used.corner - window_.minIndex(), __builtin_ctzll(word)));
    }
  }
  return voxels;
}

double Grid3d::bytesFor(double slots, double echoes) {
  return slots * (sizeof(Brick) + static_cast<double>(sizeof(Used)) / kSlotsAUsedBrick) + RayIndex::bytesFor(echoes) +
         echoes * (sizeof(Index3) + sizeof(std::uint32_t));
}

std::size_t Grid3d::memoryBytes() const {
  return bricks_.capacity() * sizeof(Brick) + used_.capacity() * sizeof(Used) + rays_.memoryBytes() +
         contents_.capacity() * sizeof(Content) + no_echoes_.capacity() * sizeof(std::uint32_t) +
         (hit_voxels_.capacity() + new_voxels_.capacity()) * sizeof(Index3);
}

}  // namespace donex
