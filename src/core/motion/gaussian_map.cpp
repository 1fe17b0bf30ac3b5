#include "core/motion/gaussian_map.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace donex {
namespace {

constexpr VoxelKey kNoKey = ~VoxelKey{0};  // keys have 63 bits
constexpr double kFull = 0.6;              // share of the slots in use: beyond, searching takes long

Index3 voxelAt(const Eigen::Vector3d& point, double edge) {
  return (point / edge).array().floor().matrix().cast<int>();
}

Eigen::Vector3d centerOf(const Index3& voxel, double edge) {
  return (voxel.cast<double>().array() + 0.5).matrix() * edge;
}

}  // namespace

GaussianMap::GaussianMap(const Options& options) : options_(options) {
  std::size_t slots = options.most_voxels;
  for (std::size_t i = 0; i < levels_.size(); ++i, slots /= 2) {
    levels_[i].edge = options.edges[i];
    levels_[i].keys.assign(slots, kNoKey);
    levels_[i].voxels.resize(slots);
  }
}

std::size_t GaussianMap::slotOf(const Level& level, VoxelKey key) {
  const std::size_t mask = level.keys.size() - 1;
  std::size_t slot = VoxelHash()(key) & mask;
  while (level.keys[slot] != key && level.keys[slot] != kNoKey) slot = (slot + 1) & mask;
  return slot;
}

GaussianMap::Voxel* GaussianMap::find(Level& level, VoxelKey key) const {
  const std::size_t slot = slotOf(level, key);
  return level.keys[slot] == key ? &level.voxels[slot] : nullptr;
}

void GaussianMap::add(const Eigen::Vector3d& point) {
  for (Level& level : levels_) add(level, point);
}

void GaussianMap::add(Level& level, const Eigen::Vector3d& point) {
  const Index3 index = voxelAt(point, level.edge);
  const VoxelKey key = keyOf(index);
  const std::size_t slot = slotOf(level, key);
  Voxel& voxel = level.voxels[slot];
  if (level.keys[slot] == kNoKey) {
    const bool is_full = static_cast<double>(level.used) > kFull * static_cast<double>(level.keys.size());
    if (is_full) return;
    level.keys[slot] = key;
    voxel = Voxel();
    ++level.used;
  }
  const Eigen::Vector3f p = (point - centerOf(index, level.edge)).cast<float>();
  if (voxel.count >= options_.most_echoes) {
    voxel.count *= 0.5F;
    voxel.fitted_count *= 0.5F;
    voxel.sum *= 0.5F;
    voxel.squares *= 0.5F;
  }
  voxel.count += 1.0F;
  voxel.sum += p;
  voxel.squares.head<3>() += p.array().square();
  voxel.squares[3] += p.x() * p.y();
  voxel.squares[4] += p.x() * p.z();
  voxel.squares[5] += p.y() * p.z();
}

SurfaceMatch GaussianMap::surfaceAt(const Eigen::Vector3d& point) {
  constexpr float kGrown = 1.1F;  // a tenth more echoes change a surface little
  for (Level& level : levels_) {
    const Index3 index = voxelAt(point, level.edge);
    Voxel* voxel = find(level, keyOf(index));
    if (voxel == nullptr || voxel->count < options_.least_echoes) continue;
    if (voxel->shape == Shape::kUnknown || voxel->count > kGrown * voxel->fitted_count) fit(level, *voxel);
    if (voxel->shape == Shape::kNone) continue;
    return {&voxel->surface, centerOf(index, level.edge) + voxel->surface.mean.cast<double>(),
            voxel->shape == Shape::kPole};
  }
  return {};
}

void GaussianMap::fit(const Level& level, Voxel& voxel) const {
  const Eigen::Vector3d mean = (voxel.sum / voxel.count).cast<double>();
  const Eigen::Array<double, 6, 1> s = (voxel.squares / voxel.count).cast<double>();
  Eigen::Matrix3d covariance;
  covariance << s[0], s[3], s[4], s[3], s[1], s[5], s[4], s[5], s[2];
  covariance -= mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  const Eigen::Vector3d values = solver.eigenvalues().cwiseMax(0.0);
  const double spread = options_.least_spread * level.edge;
  // What is seen coarsely may be bent a little.
  const double thickness = options_.most_thickness * std::sqrt(level.edge / options_.edges[0]);
  const bool is_thin = values[0] < thickness * thickness;
  const bool is_wide = values[1] > spread * spread && values[0] < 0.15 * values[1];
  const bool is_line = values[1] < thickness * thickness && values[2] > spread * spread;
  voxel.fitted_count = voxel.count;
  voxel.shape = Shape::kNone;
  if (is_thin && is_wide) {
    voxel.shape = Shape::kPlane;
    voxel.surface = {mean.cast<float>(), solver.eigenvectors().col(0).cast<float>(), static_cast<float>(values[0])};
  } else if (is_line && std::abs(solver.eigenvectors()(2, 2)) > options_.upright) {
    voxel.shape = Shape::kPole;
    voxel.surface = {mean.cast<float>(), solver.eigenvectors().col(2).cast<float>(), static_cast<float>(values[1])};
  }
}

void GaussianMap::moveTo(const Eigen::Vector3d& center) {
  const bool has_moved = (center - pruned_at_).squaredNorm() > options_.prune_distance * options_.prune_distance;
  if (has_moved) pruned_at_ = center;
  for (Level& level : levels_) {
    const auto most = 0.9 * kFull * static_cast<double>(level.keys.size());
    if (has_moved) forgetBeyond(level, center, options_.reach);
    for (double reach = options_.reach; static_cast<double>(level.used) > most && reach > 1.0; reach *= 0.8) {
      forgetBeyond(level, center, reach);
    }
  }
}

void GaussianMap::forgetBeyond(Level& level, const Eigen::Vector3d& center, double reach) {
  const Index3 near = voxelAt(center, level.edge);
  for (std::size_t slot = 0; slot < level.keys.size(); ++slot) {
    while (level.keys[slot] != kNoKey) {
      const Eigen::Vector3d position = centerOf(voxelOfKey(level.keys[slot], near), level.edge);
      if ((position - center).squaredNorm() <= reach * reach) break;
      erase(level, slot);
    }
  }
}

/// Keys that were pushed on by this one move back, so that searches need no marks of what was erased.
void GaussianMap::erase(Level& level, std::size_t slot) {
  const std::size_t mask = level.keys.size() - 1;
  std::size_t hole = slot;
  for (std::size_t next = (hole + 1) & mask; level.keys[next] != kNoKey; next = (next + 1) & mask) {
    const std::size_t home = VoxelHash()(level.keys[next]) & mask;
    const bool may_move = ((next - home) & mask) >= ((next - hole) & mask);
    if (!may_move) continue;
    level.keys[hole] = level.keys[next];
    level.voxels[hole] = level.voxels[next];
    hole = next;
  }
  level.keys[hole] = kNoKey;
  --level.used;
}

void GaussianMap::clear() {
  for (Level& level : levels_) {
    std::fill(level.keys.begin(), level.keys.end(), kNoKey);
    level.used = 0;
  }
}

std::size_t GaussianMap::memoryBytes() const {
  std::size_t bytes = 0;
  for (const Level& level : levels_) {
    bytes += level.keys.capacity() * sizeof(VoxelKey) + level.voxels.capacity() * sizeof(Voxel);
  }
  return bytes;
}

}  // namespace donex
