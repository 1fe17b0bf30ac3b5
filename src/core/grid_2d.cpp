#include "donex/core/grid_2d.h"

#include <algorithm>
#include <cmath>

namespace donex {
namespace {

constexpr int kAhead = 16;  // cells are asked of memory so many echoes before they are needed

}  // namespace

Grid2d::Grid2d(const Config& config) : window_(config), layout_(window_), cells_(layout_.slots() + 1) {
  if (config.compensation == Compensation::kResample) content_of_cell_.resize(layout_.slots());
}

void Grid2d::shift(const Eigen::Isometry3d& odom_from_base) {
  if (window_.compensation() == Compensation::kScroll) {
    layout_.scroll(window_, odom_from_base, [&](std::uint32_t slot) { cells_[slot].range = HeightRange{}; });
  } else {
    resample(odom_from_base);
  }
}

void Grid2d::resample(const Eigen::Isometry3d& odom_from_base) {
  for (const Content& content : contents_) cells_[content.slot].range = HeightRange{};
  window_.moveTo(odom_from_base);
  std::vector<Content> moved;
  moved.swap(contents_);
  const Eigen::Isometry3d grid_from_odom = window_.odomFromGrid().inverse();
  for (const Content& content : moved) place(content, grid_from_odom);
}

void Grid2d::place(const Content& content, const Eigen::Isometry3d& grid_from_odom) {
  const Eigen::Vector3d lo = toWindow(grid_from_odom * content.lo_in_odom);
  const Eigen::Vector3d hi = toWindow(grid_from_odom * content.hi_in_odom);
  const Eigen::Vector2d middle = 0.5 * (lo + hi).head<2>();
  const int x = static_cast<int>(std::floor(middle.x())), y = static_cast<int>(std::floor(middle.y()));
  if (!window_.contains({x, y, 0})) return;
  const std::uint32_t slot = layout_.slotOf(x, y);
  Cell& cell = cells_[slot];
  HeightRange range;
  range.extend(static_cast<float>(lo.z()));
  range.extend(static_cast<float>(hi.z()));
  if (cell.range.empty()) {
    cell.range = range;
    content_of_cell_[slot] = static_cast<std::uint32_t>(contents_.size());
    contents_.push_back({content.lo_in_odom, content.hi_in_odom, slot});
    return;
  }
  // Two contents in one cell: the older keeps its place and grows to the range of both.
  cell.range.extend(range);
  Content& older = contents_[content_of_cell_[slot]];
  const Eigen::Vector2d at =
      0.5 * (toWindow(grid_from_odom * older.lo_in_odom) + toWindow(grid_from_odom * older.hi_in_odom)).head<2>();
  older.lo_in_odom = fromWindow({at.x(), at.y(), cell.range.lo});
  older.hi_in_odom = fromWindow({at.x(), at.y(), cell.range.hi});
}

Eigen::Vector3d Grid2d::toWindow(const Eigen::Vector3d& in_grid) const {
  return in_grid / window_.voxelSize() - window_.minIndex().cast<double>();
}

Eigen::Vector3d Grid2d::fromWindow(const Eigen::Vector3d& in_window) const {
  return window_.odomFromGrid() * ((in_window + window_.minIndex().cast<double>()) * window_.voxelSize());
}

void Grid2d::take(const Scan& scan, EchoLabels& labels) {
  ++scan_;
  hit_.clear();
  labels.resize(scan.echoes.size());
  no_echoes_.clear();
  no_echoes_.reserve(scan.echoes.size());
  new_count_ = 0;
  if (new_voxels_.size() <= scan.echoes.size()) new_voxels_.resize(scan.echoes.size() + 1);
  const bool resamples = window_.compensation() == Compensation::kResample;
  const auto judge_block = [&](std::size_t first, const EchoBlock& block) {
    block.appendNoEchoes(first, no_echoes_);
    resamples ? judge<true>(first, block, labels) : judge<false>(first, block, labels);
  };
  forEachBlock(window_.placementOf(scan), scan.echoes, 0, blocksOf(scan.echoes.size()), judge_block);
  if (resamples) rememberContents();
}

template <bool keep_order>
void Grid2d::judge(std::size_t first, const EchoBlock& block, EchoLabels& labels) {
  BlockSlots at;
  layout_.locate(block, at);
  const float lift = layout_.lift();
  std::uint8_t* dynamic = labels.dynamic.data() + first;
  int new_echoes[EchoBlock::kSize + 1], new_count = 0;
  for (int i = 0; i < block.count; ++i) {
    if (i + kAhead < EchoBlock::kSize) __builtin_prefetch(&cells_[at.slot[i + kAhead]], 1);
    Cell& cell = cells_[at.slot[i]];
    if (cell.scan != scan_) {
      cell.scan = scan_;
      cell.before = cell.range;
      cell.range = HeightRange{};
      if (keep_order && block.inside[i] != 0) hit_.push_back(at.slot[i]);
    }
    const float height = block.z[i] + lift;
    cell.range.extend(height);
    const bool is_outside_range = static_cast<int>(height < cell.before.lo) | static_cast<int>(height > cell.before.hi);
    const bool is_new = (block.inside[i] & static_cast<int>(is_outside_range)) != 0;
    dynamic[i] = is_new ? 1 : 0;
    new_echoes[new_count] = i;
    new_count += is_new ? 1 : 0;  // written in any case: no branch to guess
  }
  std::copy_n(block.observed, block.count, labels.observed.data() + first);
  for (int i = 0; i < new_count; ++i) new_voxels_[new_count_++] = block.voxel(new_echoes[i]);
}

void Grid2d::rememberContents() {
  // A hit cell starts anew from its centre; one in the shadow keeps the residual it carries.
  const auto is_hit = [&](const Content& content) { return cells_[content.slot].scan == scan_; };
  contents_.erase(std::remove_if(contents_.begin(), contents_.end(), is_hit), contents_.end());
  for (const std::uint32_t slot : hit_) {
    const Index3 cell = layout_.cellOf(slot);
    const Eigen::Vector2d center = cell.head<2>().cast<double>().array() + 0.5;
    const HeightRange& range = cells_[slot].range;
    contents_.push_back(
        {fromWindow({center.x(), center.y(), range.lo}), fromWindow({center.x(), center.y(), range.hi}), slot});
  }
}

void Grid2d::reset() {
  std::fill(cells_.begin(), cells_.end(), Cell{});
  new_count_ = 0;
  no_echoes_.clear();
  contents_.clear();
  scan_ = 0;
  layout_.reset();
}

HeightRange Grid2d::rangeAt(int x, int y) const { return cells_[layout_.slotOf(x, y)].range; }

std::size_t Grid2d::memoryBytes() const {
  return cells_.capacity() * sizeof(Cell) + contents_.capacity() * sizeof(Content) +
         (no_echoes_.capacity() + content_of_cell_.capacity() + hit_.capacity()) * sizeof(std::uint32_t) +
         new_voxels_.capacity() * sizeof(Index3);
}

}  // namespace donex
