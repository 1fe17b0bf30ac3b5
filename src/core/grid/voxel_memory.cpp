#include "core/grid/voxel_memory.h"

#include <algorithm>
#include <array>

namespace donex {
namespace {

constexpr std::uint64_t kAll = ~std::uint64_t{0};

std::uint64_t maskOf(std::uint32_t bit) { return std::uint64_t{1} << bit; }

}  // namespace

VoxelMemory::VoxelMemory(const Config& config)
    : window_(config),
      layout_(window_.extent()),
      bricks_(layout_.slots() + 1),
      workers_(config.threads),
      parts_(static_cast<std::size_t>(config.threads)) {
  bricks_.back().remembered = kAll;  // what is outside is never new
  for (std::size_t i = 1; i < parts_.size(); ++i) {
    parts_[i].hit.resize(bricks_.size());
    parts_[i].touched.reserve(layout_.slots() / kSlotsAUsedBrick);
  }
  used_.reserve(layout_.slots() / kSlotsAUsedBrick);
  layout_.scrollTo(window_.minIndex());
}

void VoxelMemory::beginTurn(const Eigen::Isometry3d& odom_from_base) {
  rememberTurn();
  if (window_.compensation() == Compensation::kScroll) {
    scroll(odom_from_base);
  } else {
    resample(odom_from_base);
  }
}

void VoxelMemory::scroll(const Eigen::Isometry3d& odom_from_base) {
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

void VoxelMemory::resample(const Eigen::Isometry3d& odom_from_base) {
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
VoxelMemory::Brick& VoxelMemory::brickAt(std::uint32_t slot, const Index3& in_window) {
  Brick& brick = bricks_[slot];
  const bool is_empty = (brick.remembered | brick.hit) == 0;
  if (is_empty) used_.push_back(usedAt(slot, in_window));
  return brick;
}

VoxelMemory::Used VoxelMemory::usedAt(std::uint32_t slot, const Index3& in_window) const {
  return {slot, (in_window + window_.minIndex()).unaryExpr([](int i) { return i & ~3; })};
}

void VoxelMemory::hit(std::size_t part, std::size_t first, const EchoBlock& block, EchoLabels& labels) {
  BlockSlots at;
  layout_.locate(block, at);
  const auto in_first_part = [&](int i) -> std::uint64_t& {
    Brick& brick = bricks_[at.slot[i]];
    if ((brick.remembered | brick.hit) == 0) brickAt(at.slot[i], block.voxel(i));
    return brick.hit;
  };
  const auto in_other_part = [&, &own = parts_[part]](int i) -> std::uint64_t& {
    std::uint64_t& hit = own.hit[at.slot[i]];
    if (hit == 0) own.touched.push_back(usedAt(at.slot[i], block.voxel(i)));
    return hit;
  };
  part == 0 ? hit(parts_[part], first, block, at, labels, in_first_part)
            : hit(parts_[part], first, block, at, labels, in_other_part);
}

/// `hit_of(i)`: the part's own hits in the brick of the block's entry i.
template <class HitOf>
void VoxelMemory::hit(Part& part, std::size_t first, const EchoBlock& block, const BlockSlots& at, EchoLabels& labels,
                      HitOf&& hit_of) {
  constexpr auto kAhead = static_cast<int>(kBricksAhead);
  const bool keeps_order = window_.compensation() == Compensation::kResample;
  std::uint8_t* dynamic = labels.dynamic.data() + first;
  std::array<int, EchoBlock::kSize + 1> new_echoes;  // not set: a block's worth of it is written each time
  int new_count = 0;
  for (int i = 0; i < block.count; ++i) {
    if (i + kAhead < EchoBlock::kSize) __builtin_prefetch(&bricks_[at.slot[i + kAhead]], 1);
    const std::uint64_t mask = maskOf(at.bit[i]);
    const bool is_new = (bricks_[at.slot[i]].remembered & mask) == 0;
    std::uint64_t& hit = hit_of(i);
    if (keeps_order && block.inside[i] != 0 && (hit & mask) == 0) part.hit_voxels.push_back(block.voxel(i));
    hit |= mask;
    dynamic[i] = is_new ? 1 : 0;
    new_echoes[new_count] = i;
    new_count += is_new ? 1 : 0;  // written in any case: no branch to guess
  }
  std::copy_n(block.observed.data(), block.count, labels.observed.data() + first);
  part.echoes.add(first, block, new_echoes.data(), new_count);
}

void VoxelMemory::takeOver(Part& part) {
  std::vector<Index3>& in_order = parts_.front().hit_voxels;
  for (const Index3& voxel : part.hit_voxels) {
    const BrickBit at = layout_.locate(voxel);
    if ((bricks_[at.slot].hit & maskOf(at.bit)) == 0) in_order.push_back(voxel);
  }
  part.hit_voxels.clear();
  for (std::size_t i = 0; i < part.touched.size(); ++i) {
    if (i + kBricksAhead < part.touched.size()) {
      __builtin_prefetch(&bricks_[part.touched[i + kBricksAhead].slot], 1);
      __builtin_prefetch(&part.hit[part.touched[i + kBricksAhead].slot], 1);
    }
    const Used& touched = part.touched[i];
    Brick& brick = bricks_[touched.slot];
    if ((brick.remembered | brick.hit) == 0) used_.push_back(touched);
    brick.hit |= part.hit[touched.slot];
    part.hit[touched.slot] = 0;
  }
  part.touched.clear();
}

void VoxelMemory::rememberTurn() {
  forgetHitContents();
  kept_.resize(stretches());
  const auto remember_some = [&](std::size_t i) { kept_[i] = rememberSome(beginOf(i), beginOf(i + 1)); };
  workers_.each(stretches(), std::ref(remember_some));
  auto end = used_.begin();
  for (std::size_t i = 0; i < stretches(); ++i) {
    const auto first = used_.begin() + static_cast<std::ptrdiff_t>(beginOf(i));
    end = std::move(first, first + static_cast<std::ptrdiff_t>(kept_[i]), end);
  }
  used_.erase(end, used_.end());
  rememberContents();
}

/// Bricks `first` to `last` (not included) of used_; those that stay come first then, and are counted.
std::size_t VoxelMemory::rememberSome(std::size_t first, std::size_t last) {
  std::size_t kept = first;
  for (std::size_t i = first; i < last; ++i) {
    if (i + kBricksAhead < last) __builtin_prefetch(&bricks_[used_[i + kBricksAhead].slot], 1);
    Used used = used_[i];
    Brick& brick = bricks_[used.slot];
    brick = {used.rememberedOf(brick), 0};
    used.seen_through = 0;
    if (brick.remembered != 0) used_[kept++] = used;
  }
  return kept - first;
}

/// A hit voxel starts anew from its centre; one in the shadow keeps the residual it carries.
void VoxelMemory::forgetHitContents() {
  const auto is_hit = [&](const Content& content) {
    return (bricks_[content.at.slot].hit & maskOf(content.at.bit)) != 0;
  };
  contents_.erase(std::remove_if(contents_.begin(), contents_.end(), is_hit), contents_.end());
}

void VoxelMemory::rememberContents() {
  const auto is_forgotten = [&](const Content& content) {
    return (bricks_[content.at.slot].remembered & maskOf(content.at.bit)) == 0;
  };
  contents_.erase(std::remove_if(contents_.begin(), contents_.end(), is_forgotten), contents_.end());
  for (const Index3& voxel : parts_.front().hit_voxels) {
    contents_.push_back({window_.odomFromGrid() * window_.indexToCenter(voxel), layout_.locate(voxel)});
  }
  parts_.front().hit_voxels.clear();
}

void VoxelMemory::clearBricks() {
  for (const Used& used : used_) bricks_[used.slot] = Brick{};
  used_.clear();
}

void VoxelMemory::reset() {
  clearBricks();
  contents_.clear();
  for (Part& part : parts_) {
    part.echoes.clear();
    part.hit_voxels.clear();
  }
}

std::vector<Index3> VoxelMemory::remembered() const {
  std::vector<Index3> voxels;
  for (const Used& used : used_) {
    for (std::uint64_t word = used.rememberedOf(bricks_[used.slot]); word != 0; word &= word - 1) {
      voxels.push_back(BrickLayout::voxelOfBit(used.corner - window_.minIndex(), __builtin_ctzll(word)));
    }
  }
  return voxels;
}

double VoxelMemory::bytesFor(double slots, double echoes, int threads) {
  constexpr double kUsedASlot = static_cast<double>(sizeof(Used)) / kSlotsAUsedBrick;
  const double more_parts = threads - 1;
  return slots * (sizeof(Brick) + kUsedASlot + more_parts * (sizeof(std::uint64_t) + kUsedASlot)) +
         TakenEchoes::bytesFor(echoes);
}

std::size_t VoxelMemory::memoryBytes() const {
  std::size_t bytes =
      bricks_.capacity() * sizeof(Brick) + used_.capacity() * sizeof(Used) + contents_.capacity() * sizeof(Content);
  for (const Part& part : parts_) {
    bytes += part.echoes.memoryBytes() + part.hit_voxels.capacity() * sizeof(Index3) +
             part.hit.capacity() * sizeof(std::uint64_t) + part.touched.capacity() * sizeof(Used);
  }
  return bytes;
}

}  // namespace donex
