#include "core/grid/grid_2d.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace donex {
namespace {

constexpr int kCellsAhead = 16;  // cells are asked of memory so many echoes before they are needed

}  // namespace

Grid2d::Grid2d(const Config& config)
    : window_(config),
      layout_(window_),
      cells_(layout_.slots() + 1),
      workers_(config.threads),
      parts_(static_cast<std::size_t>(config.threads)) {
  if (config.compensation == Compensation::kResample) content_of_cell_.resize(layout_.slots());
  for (std::size_t i = 1; i < parts_.size(); ++i) parts_[i].taken.resize(cells_.size());
}

void Grid2d::beginTurn(const Eigen::Isometry3d& odom_from_base) {
  rememberTurn();
  if (window_.compensation() == Compensation::kScroll) {
    layout_.scroll(window_, odom_from_base, [&](std::uint32_t slot) { cells_[slot].remembered = HeightRange{}; });
  } else {
    resample(odom_from_base);
  }
}

void Grid2d::resample(const Eigen::Isometry3d& odom_from_base) {
  for (const Content& content : contents_) cells_[content.slot].remembered = HeightRange{};
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
  HeightRange& remembered = cells_[slot].remembered;
  HeightRange range;
  range.extend(static_cast<float>(lo.z()));
  range.extend(static_cast<float>(hi.z()));
  if (remembered.empty()) {
    remembered = range;
    content_of_cell_[slot] = static_cast<std::uint32_t>(contents_.size());
    contents_.push_back({content.lo_in_odom, content.hi_in_odom, slot});
    return;
  }
  // Two contents in one cell: the older keeps its place and grows to the range of both.
  remembered.extend(range);
  Content& older = contents_[content_of_cell_[slot]];
  const Eigen::Vector2d at =
      0.5 * (toWindow(grid_from_odom * older.lo_in_odom) + toWindow(grid_from_odom * older.hi_in_odom)).head<2>();
  older.lo_in_odom = fromWindow({at.x(), at.y(), remembered.lo});
  older.hi_in_odom = fromWindow({at.x(), at.y(), remembered.hi});
}

Eigen::Vector3d Grid2d::toWindow(const Eigen::Vector3d& in_grid) const {
  return in_grid / window_.voxelSize() - window_.minIndex().cast<double>();
}

Eigen::Vector3d Grid2d::fromWindow(const Eigen::Vector3d& in_window) const {
  return window_.odomFromGrid() * ((in_window + window_.minIndex().cast<double>()) * window_.voxelSize());
}

void Grid2d::take(const Scan& scan, EchoLabels& labels) {
  const std::size_t echoes = scan.echoes.size(), blocks = blocksOf(echoes);
  labels.resize(echoes);
  const Placement placement = window_.placementOf(scan);
  const auto judge_part = [&](std::size_t i) {
    const std::size_t first = firstBlockOf(i, parts_.size(), blocks), last = firstBlockOf(i + 1, parts_.size(), blocks);
    Part& part = parts_[i];
    // The first part takes the others' cells over later.
    part.begin(i == 0 ? echoes : (last - first) * EchoBlock::kSize);
    const auto taken_by_first = [&](std::uint32_t slot) -> HeightRange& { return cells_[slot].taken; };
    const auto taken_by_other = [&](std::uint32_t slot) -> HeightRange& { return part.taken[slot]; };
    forEachBlock(placement, scan.echoes, first, last, [&](std::size_t first_echo, const EchoBlock& block) {
      i == 0 ? judge(part, first_echo, block, labels, taken_by_first)
             : judge(part, first_echo, block, labels, taken_by_other);
    });
  };
  workers_.each(parts_.size(), std::ref(judge_part));  // by reference: a copy of it would be allocated
  for (std::size_t i = 1; i < parts_.size(); ++i) takeOver(parts_[i]);
}

void Grid2d::Part::begin(std::size_t most_echoes) {
  echoes.begin(most_echoes);
  if (hit.size() <= hit_count + most_echoes) hit.resize(hit_count + most_echoes + 1);
}

/// `taken_of(slot)`: what the part's own echoes have shown of a cell.
template <class TakenOf>
void Grid2d::judge(Part& part, std::size_t first, const EchoBlock& block, EchoLabels& labels, TakenOf&& taken_of) {
  BlockSlots at;
  layout_.locate(block, at);
  const float lift = layout_.lift();
  std::uint8_t* dynamic = labels.dynamic.data() + first;
  std::array<int, EchoBlock::kSize + 1> new_echoes;  // not set: a block's worth of it is written each time
  int new_count = 0;
  for (int i = 0; i < block.count; ++i) {
    if (i + kCellsAhead < EchoBlock::kSize) __builtin_prefetch(&cells_[at.slot[i + kCellsAhead]], 1);
    const HeightRange& remembered = cells_[at.slot[i]].remembered;
    HeightRange& taken = taken_of(at.slot[i]);
    const float height = block.z[i] + lift;
    const bool is_outside_range = static_cast<int>(height < remembered.lo) | static_cast<int>(height > remembered.hi);
    const int is_new = block.inside[i] & static_cast<int>(is_outside_range);
    // Both lists are written to in any case: no branch to guess.
    part.hit[part.hit_count] = at.slot[i];
    part.hit_count += static_cast<std::size_t>(block.inside[i] & static_cast<int>(taken.empty()));
    new_echoes[new_count] = i;
    new_count += is_new;
    dynamic[i] = static_cast<std::uint8_t>(is_new);
    taken.extend(height);
  }
  std::copy_n(block.observed.data(), block.count, labels.observed.data() + first);
  part.echoes.add(first, block, new_echoes.data(), new_count);
}

void Grid2d::takeOver(Part& part) {
  Part& all = parts_.front();
  for (std::size_t i = 0; i < part.hit_count; ++i) {
    if (i + kCellsAhead < part.hit_count) __builtin_prefetch(&cells_[part.hit[i + kCellsAhead]], 1);
    const std::uint32_t slot = part.hit[i];
    HeightRange& taken = cells_[slot].taken;
    if (taken.empty()) all.hit[all.hit_count++] = slot;
    taken.extend(part.taken[slot]);
    part.taken[slot] = HeightRange{};
  }
  part.hit_count = 0;
}

void Grid2d::rememberTurn() {
  if (window_.compensation() == Compensation::kResample) rememberContents();
  Part& all = parts_.front();
  for (std::size_t i = 0; i < all.hit_count; ++i) {
    Cell& cell = cells_[all.hit[i]];
    cell.remembered = cell.taken;
    cell.taken = HeightRange{};
  }
  all.hit_count = 0;
}

void Grid2d::rememberContents() {
  // A hit cell starts anew from its centre; one in the shadow keeps the residual it carries.
  const auto is_hit = [&](const Content& content) { return !cells_[content.slot].taken.empty(); };
  contents_.erase(std::remove_if(contents_.begin(), contents_.end(), is_hit), contents_.end());
  const Part& all = parts_.front();
  for (std::size_t i = 0; i < all.hit_count; ++i) {
    const std::uint32_t slot = all.hit[i];
    const Index3 cell = layout_.cellOf(slot);
    const Eigen::Vector2d center = cell.head<2>().cast<double>().array() + 0.5;
    const HeightRange& range = cells_[slot].taken;
    contents_.push_back(
        {fromWindow({center.x(), center.y(), range.lo}), fromWindow({center.x(), center.y(), range.hi}), slot});
  }
}

void Grid2d::reset() {
  std::fill(cells_.begin(), cells_.end(), Cell{});
  for (Part& part : parts_) {
    part.echoes.clear();
    part.hit_count = 0;
  }
  contents_.clear();
  layout_.reset();
}

HeightRange Grid2d::rangeAt(int x, int y) const {
  const Cell& cell = cells_[layout_.slotOf(x, y)];
  return cell.taken.empty() ? cell.remembered : cell.taken;
}

double Grid2d::bytesFor(double slots, double echoes, int threads) {
  const double more_parts = threads - 1;
  const double an_echo = TakenEchoes::bytesFor(1.0) + sizeof(std::uint32_t);
  return slots * (sizeof(Cell) + more_parts * sizeof(HeightRange)) + echoes * an_echo * (1.0 + more_parts / threads);
}

std::size_t Grid2d::memoryBytes() const {
  std::size_t bytes = cells_.capacity() * sizeof(Cell) + contents_.capacity() * sizeof(Content) +
                      content_of_cell_.capacity() * sizeof(std::uint32_t);
  for (const Part& part : parts_) {
    bytes += part.echoes.memoryBytes() + part.hit.capacity() * sizeof(std::uint32_t) +
             part.taken.capacity() * sizeof(HeightRange);
  }
  return bytes;
}

}  // namespace donex
