// Is an echo's place new, settled, or neither? The question of both grids, each from its own memory.
#pragma once

#include <array>
#include <cstdint>

#include "core/evidence/birth_memory.h"
#include "core/evidence/judged_scan.h"
#include "core/grid/cell_layout.h"
#include "core/sight/sight_history.h"

namespace donex {

struct ScanClockOptions {
  double found_window = 0.5;  ///< what appears in unknown space and stays for so long was there before [s]
  /// A settled voxel is a neighbouring surface while it was hit so lately: the three scans before, at 10 Hz [s].
  double recent_time = 0.35;
};

/// The scans so far by number, and which births count as young.
class ScanClock {
 public:
  /// `birth_window` [s]: places that had been seen free settle after it; others after the found window at most.
  explicit ScanClock(double birth_window, const ScanClockOptions& options = {});

  /// Begins the next scan [s].
  void begin(double stamp);
  void reset();

  std::uint32_t scan() const { return scan_; }  ///< 1 for the first
  bool isYoung(std::uint32_t birth, bool was_free) const { return birth >= (was_free ? new_since_ : found_since_); }
  bool isRecent(std::uint32_t scan) const { return scan >= recent_since_; }
  /// Stamp of a scan [s], as far as they are remembered; earlier scans count as before everything.
  double stampOf(std::uint32_t scan) const;

 private:
  static constexpr std::size_t kRememberedStamps = 600;

  void advance(std::uint32_t& since, double window) const;

  double new_window_, found_window_, recent_time_;  ///< [s]
  std::uint32_t scan_ = 0;
  std::uint32_t new_since_ = 1, found_since_ = 1;   ///< oldest births that are young
  std::uint32_t recent_since_ = 1;                  ///< oldest scan that is recent
  std::array<double, kRememberedStamps> stamps_{};  ///< [s] by scan, modulo their number
};

/// The 3D grid's answer, from each voxel's birth (algorithm: "Evidence").
class Newness3d {
 public:
  explicit Newness3d(const Config& config) : config_(config.evidence), memory_(config) {}

  void shift(const Eigen::Isometry3d& odom_from_base) { memory_.shift(odom_from_base); }

  /// Asks memory for what an echo's judgement will need.
  void expect(const Eigen::Vector3f& in_window) const { memory_.expect(voxelOf(in_window)); }

  /// Judges one echo of the present scan and remembers it. `in_window` in voxel edge lengths, `point` the
  /// same in [m], as `before` is asked. A scan's echoes of one voxel share the judgement of the first.
  Place judge(const Eigen::Vector3f& in_window, const Eigen::Vector3f& point, const ScanClock& clock,
              const SightView& before);

  void reset() { memory_.reset(); }
  const BirthMemory& memory() const { return memory_; }
  const GridWindow& window() const { return memory_.window(); }
  std::size_t memoryBytes() const { return memory_.memoryBytes(); }
  /// What memoryBytes will be for a window of so many voxels [bytes], see BirthMemory.
  static double bytesFor(const Eigen::Vector3d& extent) { return BirthMemory::bytesFor(extent); }

 private:
  bool touchesSettled(const Index3& voxel, const ScanClock& clock) const;

  EvidenceConfig config_;
  BirthMemory memory_;
};

/// The 2D grid's answer, from ranges of heights a cell: ranging, previous range and resizing with a past
/// (algorithm: "Evidence in 2D"). Only the extension of a range is judged anew.
class Newness2d {
 public:
  explicit Newness2d(const Config& config);

  void shift(const Eigen::Isometry3d& odom_from_base);
  void expect(const Eigen::Vector3f& in_window) const {
    const Index3 voxel = voxelOf(in_window);
    __builtin_prefetch(&cells_[cells_layout_.slotOf(voxel.x(), voxel.y())], 1);
  }
  /// As Newness3d::judge; an echo inside a known range shares that range's judgement. Heights that were found
  /// at a surface stay there until they settle: they share that judgement, not the one of what was found around them.
  Place judge(const Eigen::Vector3f& in_window, const Eigen::Vector3f& point, const ScanClock& clock,
              const SightView& before);
  void reset();
  const GridWindow& window() const { return window_; }
  std::size_t memoryBytes() const { return cells_.capacity() * sizeof(Cell); }
  /// What memoryBytes will be for a window of so many voxels [bytes].
  static double bytesFor(const Eigen::Vector3d& extent) { return extent.head<2>().prod() * sizeof(Cell); }

 private:
  struct Cell {
    HeightRange settled;     ///< occupied for longer than the birth window
    HeightRange arrived;     ///< new
    HeightRange found;       ///< unobserved, or at a surface
    HeightRange surely;      ///< the part of `arrived` that had surely been free
    HeightRange coarsely;    ///< the part of `arrived` that beams far apart had seen free
    HeightRange overlooked;  ///< the part of `arrived` that had been out of view for long
    HeightRange at_surface;  ///< the part of `found` that belonged to a surface when it was found
    std::uint32_t arrived_birth = 0, found_birth = 0;
    std::uint32_t last_hit = 0, hit_before = 0;  ///< scans

    Place placeInArrived(float height, const ScanClock& clock) const;
    Place placeInFound(float height) const { return at_surface.holds(height) ? Place::kAtSurface : Place::kUnobserved; }
  };

  Cell& cellAt(int x, int y) { return cells_[cells_layout_.slotOf(x, y)]; }
  void settle(Cell& cell, const ScanClock& clock) const;
  bool touchesSettled(int x, int y, float height) const;

  EvidenceConfig config_;
  GridWindow window_;
  CellLayout cells_layout_;
  std::vector<Cell> cells_;
};

/// What earlier scans say of a place that is hit now.
struct PlaceBefore {
  bool was_free = false;
  bool surely_free = false;    ///< most scans that knew anything of it saw it free
  bool coarsely_free = false;  ///< free, but seen by beams so far apart that something low may have stood between them
  bool overlooked = false;     ///< free, but then out of view for so long that what came may have stopped since
  bool surface = false;        ///< not free: a surface was seen there for longer than anything takes to come
};

struct WeighingOptions {
  /// Free scans that outweigh one that saw a surface before: a beam that grazes an edge is as often beside it as on it.
  int stale_weight = 2;
  double overlooked_time = 0.5;  ///< out of view since it was last seen free, as long as what is found is young [s]
};

/// Weighs what the scans since `since` [s] saw at `point`. `known`: the place is remembered, so it is forgotten only by
/// being seen through; `settled`: careful sight wants more scans for it.
PlaceBefore weigh(const EvidenceConfig& config, const SightView& before, const Eigen::Vector3f& point, double since,
                  bool known, bool settled, const WeighingOptions& options = {});

}  // namespace donex
