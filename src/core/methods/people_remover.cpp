#include "core/methods/people_remover.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/grid/brick_mask.h"
#include "core/methods/comparison_detector.h"
#include "core/methods/drive_voxels.h"
#include "core/methods/point_shadows.h"

namespace donex {
namespace {

class PeopleRemover : public ComparisonDetector<WholeDriveDetector> {
 public:
  PeopleRemover(const Config& config, const PeopleRemoverOptions& options)
      : ComparisonDetector(config),
        options_(options),
        diagonal_(static_cast<float>(std::sqrt(3.0) * config.voxel_size)),
        shadows_(diagonal_, static_cast<float>(options.fuzz)),
        layout_(window().extent()),
        foreign_(layout_.slots()),
        own_(layout_.slots()),
        freed_(layout_.slots()) {}

  bool nextPass() override {
    if (isLastPass()) return false;
    if (pass_ == Pass::kFreeVoxels) {
      voxels_.dropSmallClusters(static_cast<std::size_t>(std::max(options_.min_cluster, 1)));
      if (options_.subvoxel) voxels_.markHalfFreed();
    }
    pass_ = pass_ == Pass::kCountHits ? Pass::kFreeVoxels : Pass::kLabelEchoes;
    scan_ = 0;
    guard().reset();
    return true;
  }

  int passes() const override { return 3; }
  bool isLastPass() const override { return pass_ == Pass::kLabelEchoes; }

 protected:
  void judge(const Scan& scan, const GridScan& in_grid, EchoLabels& labels) override {
    selectEchoes(scan, in_grid);
    switch (pass_) {
      case Pass::kCountHits: countHits(in_grid); break;
      case Pass::kFreeVoxels: freeVoxels(scan, in_grid); break;
      case Pass::kLabelEchoes: labelEchoes(in_grid, labels); break;
    }
    ++scan_;
  }

  void forget() override {
    if (pass_ == Pass::kCountHits && scan_ == 0) return;
    throw std::logic_error("peopleremover judges whole drives: one that begins anew must be given as two drives");
  }

  std::size_t methodBytes() const override {
    return voxels_.memoryBytes() + shadows_.memoryBytes() + foreign_.bytes() + own_.bytes() + freed_.bytes();
  }

 private:
  enum class Pass { kCountHits, kFreeVoxels, kLabelEchoes };

  Index3 voxelAt(const Eigen::Vector3f& in_window) const { return voxelOf(in_window) + window().minIndex(); }

  void selectEchoes(const Scan& scan, const GridScan& in_grid) {
    has_sight_.assign(scan.echoes.size(), 0);
    has_hit_.assign(scan.echoes.size(), 0);
    for (std::size_t i = 0; i < has_sight_.size(); ++i) {
      has_sight_[i] = in_grid.echoes[i].allFinite() && scan.echoes[i].norm() > diagonal_ ? 1 : 0;
      has_hit_[i] = has_sight_[i] != 0 && in_grid.inside[i] != 0 ? 1 : 0;
    }
  }

  void countHits(const GridScan& in_grid) {
    for (std::size_t i = 0; i < has_hit_.size(); ++i) {
      if (has_hit_[i] != 0) voxels_.add(voxelAt(in_grid.echoes[i]), scan_);
    }
  }

  /// The voxels of the drive in this scan's window, its own and those of others.
  void placeVoxels() {
    foreign_.clear();
    own_.clear();
    freed_.clear();
    const Index3 low = window().minIndex();
    voxels_.visitBox(low, low + window().extent(), [&](const Index3& index, const DriveVoxel& voxel) {
      const bool is_own = voxel.isHitNear(scan_, static_cast<std::uint32_t>(options_.diff));
      (is_own ? own_ : foreign_).set(layout_.locate(index - low));
    });
  }

  void freeVoxels(const Scan& scan, const GridScan& in_grid) {
    placeVoxels();
    const auto* farthest = options_.point_shadows ? &shadows_.cast(scan.echoes, has_sight_) : nullptr;
    for (std::size_t i = 0; i < has_sight_.size(); ++i) {
      if (has_sight_[i] == 0) continue;
      const float share = farthest == nullptr ? 1.0F : (*farthest)[i] / scan.echoes[i].norm();
      const Eigen::Vector3f sight = in_grid.echoes[i] - in_grid.origin;
      if (share > 0.0F) traverse(in_grid.origin, in_grid.origin + std::min(share, 1.0F) * sight);
    }
    keepFreed();
  }

  void keepFreed() {
    for (const std::uint32_t slot : freed_.used()) {
      for (std::uint64_t word = freed_.word(slot); word != 0; word &= word - 1) {
        const Index3 voxel = BrickLayout::voxelOfBit(layout_.cornerOf(slot), __builtin_ctzll(word));
        voxels_.find(voxel + window().minIndex())->free = true;
      }
    }
  }

  /// Frees the voxels on the line; false where it ends in one.
  bool freeVoxel(const Index3& voxel) {
    if (!window().contains(voxel)) return false;
    const BrickBit at = layout_.locate(voxel);
    if (own_.test(at)) return false;
    if (foreign_.test(at)) freed_.set(at);
    return true;
  }

  void traverse(const Eigen::Vector3f& origin, const Eigen::Vector3f& end) {
    const LineOfSight line(origin, end);
    for (const Index3& voxel : line) {
      if (!freeVoxel(voxel)) return;
    }
    freeVoxel(line.echoVoxel());
  }

  void labelEchoes(const GridScan& in_grid, EchoLabels& labels) const {
    for (std::size_t i = 0; i < has_hit_.size(); ++i) {
      if (has_hit_[i] == 0) continue;
      labels.observed[i] = 1;
      const DriveVoxel* voxel = voxels_.find(voxelAt(in_grid.echoes[i]));
      if (voxel == nullptr) throw std::logic_error("peopleremover: this pass shows other scans than the first");
      const bool is_dynamic =
          voxel->free || std::binary_search(voxel->half_freed.begin(), voxel->half_freed.end(), scan_);
      labels.dynamic[i] = is_dynamic ? 1 : 0;
    }
  }

  PeopleRemoverOptions options_;
  float diagonal_;  ///< of a voxel [m]
  Pass pass_ = Pass::kCountHits;
  std::uint32_t scan_ = 0;
  DriveVoxels voxels_;  ///< in the odometry frame
  PointShadows shadows_;
  BrickLayout layout_;
  BrickMask foreign_, own_, freed_;  ///< in the window
  // Per echo of the scan: its line of sight counts; it hits its voxel.
  std::vector<std::uint8_t> has_sight_, has_hit_;
};

}  // namespace

std::unique_ptr<WholeDriveDetector> makePeopleRemover(const Config& config, const PeopleRemoverOptions& options) {
  requireSound(config);
  return std::make_unique<PeopleRemover>(config, options);
}

double peopleRemoverBytes(const Config& config, double) {
  constexpr double kMasks = 3.0 * sizeof(std::uint64_t);  // bytes per brick: foreign, own, freed
  return kMasks * (GridWindow::extentOf(config.scrolling()) / GridWindow::kBrick).prod();
}

}  // namespace donex
