#include "core/evidence/birth_memory.h"

#include <algorithm>
#include <stdexcept>

namespace donex {
namespace {

/// Bricks with room from the beginning: unused memory is never touched, and no brick is ever moved.
double bricksFor(const Eigen::Vector3d& extent) { return (extent.head<2>() / GridWindow::kBrick).prod(); }

}  // namespace

BirthMemory::BirthMemory(const Config& config)
    : window_(config), layout_(window_.extent()), brick_of_slot_(layout_.slots(), kNoBrick) {
  if (config.compensation != Compensation::kScroll) throw std::invalid_argument("births cannot be resampled");
  layout_.scrollTo(window_.minIndex());
  bricks_.reserve(static_cast<std::size_t>(bricksFor(window_.extent().cast<double>())));
}

void BirthMemory::shift(const Eigen::Isometry3d& odom_from_base) {
  const Index3 before = window_.minIndex();
  window_.moveTo(odom_from_base);
  const Index3 moved = window_.minIndex() - before;
  if (moved.isZero()) return;
  for (std::uint32_t brick = 0; brick < bricks_.size();) {
    const bool stays = window_.contains(layout_.cornerOf(bricks_[brick].slot) - moved);
    if (stays) {
      ++brick;
    } else {
      forget(brick);  // another brick takes its number
    }
  }
  layout_.scrollTo(window_.minIndex());
}

void BirthMemory::forget(std::uint32_t brick) {
  brick_of_slot_[bricks_[brick].slot] = kNoBrick;
  if (brick + 1 != bricks_.size()) {
    bricks_[brick] = bricks_.back();
    brick_of_slot_[bricks_[brick].slot] = brick;
  }
  bricks_.pop_back();
}

const VoxelRecord* BirthMemory::find(const Index3& in_window) const {
  const BrickBit at = layout_.locate(in_window);
  const std::uint32_t brick = brick_of_slot_[at.slot];
  if (brick == kNoBrick) return nullptr;
  const VoxelRecord& record = bricks_[brick].records[at.bit];
  return record.occupied() ? &record : nullptr;
}

VoxelRecord& BirthMemory::at(const Index3& in_window) {
  const BrickBit at = layout_.locate(in_window);
  std::uint32_t& brick = brick_of_slot_[at.slot];
  if (brick == kNoBrick) {
    brick = static_cast<std::uint32_t>(bricks_.size());
    bricks_.push_back({at.slot, {}});
  }
  return bricks_[brick].records[at.bit];
}

void BirthMemory::reset() {
  std::fill(brick_of_slot_.begin(), brick_of_slot_.end(), kNoBrick);
  bricks_.clear();
}

double BirthMemory::bytesFor(const Eigen::Vector3d& extent) {
  return (extent / GridWindow::kBrick).prod() * sizeof(std::uint32_t) + bricksFor(extent) * sizeof(Brick);
}

std::size_t BirthMemory::memoryBytes() const {
  return brick_of_slot_.capacity() * sizeof(std::uint32_t) + bricks_.capacity() * sizeof(Brick);
}

}  // namespace donex
