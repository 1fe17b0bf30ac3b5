#include "paper_detectors.h"

#include "donex/core/grid_2d.h"
#include "donex/core/grid_3d.h"
#include "donex/core/stream_guard.h"
#include "donex/core/z_buffer_grid.h"

namespace donex {
namespace {

/// What both grids share: the window, the labels of the last scan and the order of the steps.
template <class Grid>
class PaperDetector : public Detector {
 public:
  explicit PaperDetector(const Config& config) : grid_(config) {}

  void process(const Scan& scan, EchoLabels& labels) override {
    guard_.admit(scan);
    grid_.shift(scan.odom_from_base);
    grid_.window().enter(scan, scan_);
    detectNew(labels);
    if (watched_) before_ = rememberedCells();
    update();
    dynamic_ = labels.dynamic;
    is_first_ = false;
  }

  void reset() override {
    grid_.reset();
    guard_.reset();
    dynamic_.clear();
    is_first_ = true;
  }

  const std::vector<Object>& objects() const override { return no_objects_; }

  std::vector<Eigen::Vector3f> dynamicCells() const override {
    return cellCenters(grid_.window(), scan_, dynamic_);
  }

  std::vector<EchoReason> reasons() const override {
    std::vector<EchoReason> reasons(dynamic_.size(), EchoReason::kSettled);
    for (std::size_t i = 0; i < reasons.size(); ++i) {
      if (scan_.inside[i] == 0) {
        reasons[i] = scan_.echoes[i].allFinite() ? EchoReason::kOutside : EchoReason::kNoEcho;
      } else if (dynamic_[i] != 0) {
        reasons[i] = EchoReason::kMoving;
      }
    }
    return reasons;
  }

  MemoryCells memoryCells() const override;
  void watch(bool watched) override {
    watched_ = watched;
    before_.clear();
  }

  GridOutline outline() const override { return grid_.window().outline(); }

  std::size_t memoryBytes() const override {
    return grid_.memoryBytes() + scan_.echoes.capacity() * sizeof(Eigen::Vector3f) + scan_.inside.capacity() +
           dynamic_.capacity();
  }

 private:
  void detectNew(EchoLabels& labels) const {
    labels.assign(scan_.echoes.size());
    if (is_first_) return;  // nothing is known yet, so nothing is new
    for (std::size_t i = 0; i < scan_.echoes.size(); ++i) {
      if (scan_.inside[i] == 0) continue;
      labels.observed[i] = 1;
      labels.dynamic[i] = isRemembered(scan_.echoes[i]) ? 0 : 1;
    }
  }

  bool isRemembered(const Eigen::Vector3f& echo) const;
  std::vector<Index3> rememberedCells() const;
  void update();

  Grid grid_;
  StreamGuard guard_;
  GridScan scan_;
  std::vector<std::uint8_t> dynamic_;
  std::vector<Object> no_objects_;
  bool is_first_ = true;
  bool watched_ = false;
  std::vector<Index3> before_;  ///< remembered before the last scan, in its window; only while watched
};

// The 3D grids; the 2D grid's own steps follow.

template <class Grid>
bool PaperDetector<Grid>::isRemembered(const Eigen::Vector3f& echo) const {
  return grid_.remembers(voxelOf(echo));
}

template <class Grid>
std::vector<Index3> PaperDetector<Grid>::rememberedCells() const {
  return grid_.remembered();
}

template <class Grid>
MemoryCells PaperDetector<Grid>::memoryCells() const {
  MemoryCells cells;
  const GridWindow& window = grid_.window();
  const auto inOdom = [&](const Index3& voxel) {
    return Eigen::Vector3f((window.odomFromGrid() * window.indexToCenter(voxel)).cast<float>());
  };
  // Before the scan there were all of these: what was not forgotten was hit, or is in the shadow.
  for (const Index3& voxel : before_) {
    if (!grid_.remembers(voxel)) cells.seen_through.push_back(inOdom(voxel));
    else if (!grid_.isHit(voxel)) cells.shadowed.push_back(inOdom(voxel));
  }
  return cells;
}

template <class Grid>
void PaperDetector<Grid>::update() {
  grid_.hit(scan_);
  grid_.deshadow(scan_);
  grid_.remember();
}

template <>
bool PaperDetector<Grid2d>::isRemembered(const Eigen::Vector3f& echo) const {
  return grid_.remembers(echo);
}

template <>
std::vector<Index3> PaperDetector<Grid2d>::rememberedCells() const {
  return {};
}

template <>
MemoryCells PaperDetector<Grid2d>::memoryCells() const {
  return {};
}

template <>
void PaperDetector<Grid2d>::update() {
  grid_.resize(scan_);
}

}  // namespace

std::unique_ptr<Detector> makePaperDetector3d(const Config& config) {
  return std::make_unique<PaperDetector<Grid3d>>(config);
}
std::unique_ptr<Detector> makeZBufferDetector(const Config& config) {
  return std::make_unique<PaperDetector<ZBufferGrid>>(config);
}
std::unique_ptr<Detector> makePaperDetector2d(const Config& config) {
  return std::make_unique<PaperDetector<Grid2d>>(config);
}

}  // namespace donex
