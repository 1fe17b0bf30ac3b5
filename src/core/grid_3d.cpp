#include "donex/core/grid_3d.h"

namespace donex {

Grid3d::Grid3d(const Config& config)
    : window_(config), layout_(window_.extent()), remembered_(layout_.slots()), hit_(layout_.slots()) {
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
  const Index3 moved = window_.minIndex() - before;
  if (moved.isZero()) return;
  remembered_.transform([&](std::uint32_t slot, std::uint64_t word) {
    return window_.contains(layout_.cornerOf(slot) - moved) ? word : 0;
  });
  layout_.scrollTo(window_.minIndex());
}

void Grid3d::resample(const Eigen::Isometry3d& odom_from_base) {
  window_.moveTo(odom_from_base);
  const Eigen::Isometry3d grid_from_odom = window_.odomFromGrid().inverse();
  remembered_.clear();
  std::size_t kept = 0;
  for (Content& content : contents_) {
    const Eigen::Vector3d in_grid = grid_from_odom * content.in_odom / window_.voxelSize();
    const Index3 voxel = in_grid.array().floor().cast<int>().matrix() - window_.minIndex();
    if (!window_.contains(voxel)) continue;
    content.at = layout_.locate(voxel);
    // Two contents in one voxel: the older stays, so a content never moves by another's residual.
    if (remembered_.set(content.at)) contents_[kept++] = content;
  }
  contents_.resize(kept);
}

void Grid3d::hit(const GridScan& scan) {
  const bool keep_order = window_.compensation() == Compensation::kResample;
  hit_.clear();
  hit_voxels_.clear();
  for (std::size_t i = 0; i < scan.echoes.size(); ++i) {
    if (scan.inside[i] == 0) continue;
    const Index3 voxel = voxelOf(scan.echoes[i]);
    const bool is_first = hit_.set(layout_.locate(voxel));
    if (is_first && keep_order) hit_voxels_.push_back(voxel);
  }
}

void Grid3d::deshadow(const GridScan& scan) {
  rays_.build(scan.origin, scan.echoes);
  remembered_.transform([&](std::uint32_t slot, std::uint64_t word) {
    std::uint64_t candidates = word & ~hit_.word(slot);
    if (candidates == 0) return word;
    const Index3 corner = layout_.cornerOf(slot);
    if (!rays_.maySeeThrough(corner, GridWindow::kBrick)) return word;
    for (; candidates != 0; candidates &= candidates - 1) {
      const int bit = __builtin_ctzll(candidates);
      if (rays_.seesThrough(BrickLayout::voxelOfBit(corner, bit))) word &= ~(std::uint64_t{1} << bit);
    }
    return word;
  });
}

void Grid3d::remember() {
  if (window_.compensation() == Compensation::kResample) rememberContents();
  for (const std::uint32_t slot : hit_.used()) remembered_.add(slot, hit_.word(slot));
}

void Grid3d::rememberContents() {
  // A hit voxel starts anew from its centre; one in the shadow keeps the residual it carries.
  std::size_t kept = 0;
  for (const Content& content : contents_) {
    if (remembered_.test(content.at) && !hit_.test(content.at)) contents_[kept++] = content;
  }
  contents_.resize(kept);
  for (const Index3& voxel : hit_voxels_) {
    contents_.push_back({window_.odomFromGrid() * window_.indexToCenter(voxel), layout_.locate(voxel)});
  }
}

void Grid3d::reset() {
  remembered_.clear();
  hit_.clear();
  contents_.clear();
  hit_voxels_.clear();
}

std::vector<Index3> Grid3d::remembered() const {
  std::vector<Index3> voxels;
  for (const std::uint32_t slot : remembered_.used()) {
    const Index3 corner = layout_.cornerOf(slot);
    for (std::uint64_t word = remembered_.word(slot); word != 0; word &= word - 1) {
      voxels.push_back(BrickLayout::voxelOfBit(corner, __builtin_ctzll(word)));
    }
  }
  return voxels;
}

std::size_t Grid3d::memoryBytes() const {
  return remembered_.bytes() + hit_.bytes() + rays_.memoryBytes() + contents_.capacity() * sizeof(Content) +
         hit_voxels_.capacity() * sizeof(Index3);
}

}  // namespace donex
