#include "donex/core/grid_2d.h"

#include <algorithm>
#include <cmath>

namespace donex {
namespace {

int wrapped(int i, int n) { return i >= n ? i - n : i; }
int modulo(int i, int n) { return (i % n + n) % n; }

}  // namespace

Grid2d::Grid2d(const Config& config)
    : window_(config),
      width_(window_.extent().x()),
      depth_(window_.extent().y()),
      cells_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(depth_)) {}

std::uint32_t Grid2d::slotOf(int x, int y) const {
  return static_cast<std::uint32_t>(wrapped(y + shift_y_, depth_) * width_ + wrapped(x + shift_x_, width_));
}

std::uint32_t Grid2d::slotOf(const Eigen::Vector3f& echo) const {
  return slotOf(static_cast<int>(std::floor(echo.x())), static_cast<int>(std::floor(echo.y())));
}

void Grid2d::shift(const Eigen::Isometry3d& odom_from_base) {
  if (window_.compensation() == Compensation::kScroll) {
    scroll(odom_from_base);
  } else {
    resample(odom_from_base);
  }
}

void Grid2d::scroll(const Eigen::Isometry3d& odom_from_base) {
  const Index3 before = window_.minIndex();
  window_.moveTo(odom_from_base);
  const Index3 moved = window_.minIndex() - before;
  lift_ = is_first_ ? 0 : lift_ + moved.z();
  is_first_ = false;
  shift_x_ = modulo(window_.minIndex().x(), width_);
  shift_y_ = modulo(window_.minIndex().y(), depth_);
  forgetEntered(moved.x(), moved.y());
}

void Grid2d::forgetEntered(int moved_x, int moved_y) {
  // The slots of cells that entered the window still hold the cells that left it.
  const int x_first = moved_x > 0 ? std::max(0, width_ - moved_x) : 0;
  const int x_end = moved_x > 0 ? width_ : std::min(width_, -moved_x);
  for (int y = 0; y < depth_; ++y) {
    const bool row_entered = y + moved_y < 0 || y + moved_y >= depth_;
    const int first = row_entered ? 0 : x_first;
    const int end = row_entered ? width_ : x_end;
    for (int x = first; x < end; ++x) cells_[slotOf(x, y)].range = HeightRange{};
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
  if (x < 0 || x >= width_ || y < 0 || y >= depth_) return;
  Cell& cell = cells_[slotOf(x, y)];
  HeightRange range;
  range.extend(static_cast<float>(lo.z()));
  range.extend(static_cast<float>(hi.z()));
  if (cell.range.empty()) {
    cell.range = range;
    cell.content = static_cast<std::uint32_t>(contents_.size());
    contents_.push_back({content.lo_in_odom, content.hi_in_odom, slotOf(x, y)});
    return;
  }
  // Two contents in one cell: the older keeps its place and grows to the range of both.
  cell.range.extend(range.lo);
  cell.range.extend(range.hi);
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
    cell.range.extend(heightOf(echo));
  }
  if (window_.compensation() == Compensation::kResample) rememberContents();
}

void Grid2d::rememberContents() {
  // A hit cell starts anew from its centre; one in the shadow keeps the residual it carries.
  const auto is_hit = [&](const Content& content) { return cells_[content.slot].scan == scan_; };
  contents_.erase(std::remove_if(contents_.begin(), contents_.end(), is_hit), contents_.end());
  for (const std::uint32_t slot : hit_) {
    const int x = modulo(static_cast<int>(slot) % width_ - shift_x_, width_);
    const int y = modulo(static_cast<int>(slot) / width_ - shift_y_, depth_);
    const HeightRange& range = cells_[slot].range;
    contents_.push_back({fromWindow({x + 0.5, y + 0.5, range.lo}), fromWindow({x + 0.5, y + 0.5, range.hi}), slot});
  }
}

void Grid2d::reset() {
  std::fill(cells_.begin(), cells_.end(), Cell{});
  contents_.clear();
  scan_ = 0;
  is_first_ = true;
}

HeightRange Grid2d::rangeAt(int x, int y) const { return cells_[slotOf(x, y)].range; }

std::size_t Grid2d::memoryBytes() const {
  return cells_.capacity() * sizeof(Cell) + contents_.capacity() * sizeof(Content) +
         hit_.capacity() * sizeof(std::uint32_t);
}

}  // namespace donex
