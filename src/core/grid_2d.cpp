#include "donex/core/grid_2d.h"

#include <algorithm>
#include <cmath>

namespace donex {
Grid2d::Grid2d(const Config& config) : window_(config), layout_(window_), cells_(layout_.slots()) {}

std::uint32_t Grid2d::slotOf(const Eigen::Vector3f& echo) const {
  return layout_.slotOf(static_cast<int>(std::floor(echo.x())), static_cast<int>(std::floor(echo.y())));
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
    cell.content = static_cast<std::uint32_t>(contents_.size());
    contents_.push_back({content.lo_in_odom, content.hi_in_odom, slot});
    return;
  }
  // Two contents in one cell: the older keeps its place and grows to the range of both.
  cell.range.extend(range);
  Content& older = contents_[cell.content];
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

void Grid2d::resize(const GridScan& scan) {
  ++scan_;
  hit_.clear();
  for (std::size_t i = 0; i < scan.echoes.size(); ++i) {
    if (scan.inside[i] == 0) continue;
    const Eigen::Vector3f& echo = scan.echoes[i];
    const std::uint32_t slot = slotOf(echo);
    Cell& cell = cells_[slot];
    if (cell.scan != scan_) {
      cell.scan = scan_;
      cell.range = HeightRange{};
      if (window_.compensation() == Compensation::kResample) hit_.push_back(slot);
    }
    cell.range.extend(layout_.heightOf(echo));
  }
  if (window_.compensation() == Compensation::kResample) rememberContents();
}

void Grid2d::rememberContents() {
  // A hit cell starts anew from its centre; one in the shadow keeps the residual it carries.
  const auto is_hit = [&](const Content& content) { return cells_[content.slot].scan == scan_; };
  contents_.erase(std::remove_if(contents_.begin(), contents_.end(), is_hit), contents_.end());
  for (const std::uint32_t slot : hit_) {
    const Index3 cell = layout_.cellOf(slot);
    const Eigen::Vector2d center = cell.head<2>().cast<double>().array() + 0.5;
    const HeightRange& range = cells_[slot].range;
    contents_.push_back({fromWindow({center.x(), center.y(), range.lo}),
                         fromWindow({center.x(), center.y(), range.hi}), slot});
  }
}

void Grid2d::reset() {
  std::fill(cells_.begin(), cells_.end(), Cell{});
  contents_.clear();
  scan_ = 0;
  layout_.reset();
}

HeightRange Grid2d::rangeAt(int x, int y) const { return cells_[layout_.slotOf(x, y)].range; }

std::size_t Grid2d::memoryBytes() const {
  return cells_.capacity() * sizeof(Cell) + contents_.capacity() * sizeof(Content) +
         hit_.capacity() * sizeof(std::uint32_t);
}

}  // namespace donex
