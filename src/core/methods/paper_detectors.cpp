#include <algorithm>

#include "core/grid/grid_2d.h"
#include "core/grid/grid_3d.h"
#include "core/grid/voxel_memory.h"
#include "core/methods/detectors.h"
#include "core/methods/stream_guard.h"
#include "core/sight/ray_index.h"
#include "core/sight/sampled_turns.h"
#include "core/sight/z_buffer.h"

namespace donex {
namespace {

/// Voxels of the window that the cloud hits, in order.
std::vector<Index3> hitVoxels(const GridWindow& window, const Scan& scan) {
  GridScan in_grid;
  window.enter(scan, in_grid);
  std::vector<Index3> voxels;
  for (std::size_t i = 0; i < in_grid.echoes.size(); ++i) {
    if (in_grid.inside[i] != 0) voxels.push_back(voxelOf(in_grid.echoes[i]));
  }
  std::sort(voxels.begin(), voxels.end(), isBefore);
  return voxels;
}

constexpr double kKeptLabels = 2.0;  // bytes per echo of the labels that are kept

std::vector<Index3> rememberedBy(const Grid2d&) { return {}; }
template <class SeeThrough>
std::vector<Index3> rememberedBy(const Grid3d<SeeThrough>& grid) {
  return grid.remembered();
}

/// What both grids share: the stream's order, its turns, and that nothing is new in the first one.
template <class Grid>
class PaperDetector : public Detector {
 public:
  explicit PaperDetector(const Config& config) : grid_(config) {}

  void process(const Scan& scan, EchoLabels& labels) override {
    guard_.admit(scan);
    if (turns_.arrive(scan) != TurnPart::kContinuing) beginTurn(scan.odom_from_base);
    if (watched_) before_ = rememberedBy(grid_);
    grid_.take(scan, labels);
    if (watched_) hit_ = hitVoxels(grid_.window(), scan);
    if (!knows_) std::fill(labels.dynamic.begin(), labels.dynamic.end(), 0);
    judged_ = labels;
    if (!knows_) labels.assign(scan.echoes.size());  // nothing is known yet, so nothing is new
  }

  void reset() override {
    grid_.reset();
    guard_.reset();
    turns_.reset();
    judged_.resize(0);
    before_.clear();
    has_turn_ = knows_ = false;
  }

  const std::vector<Object>& objects() const override { return no_objects_; }

  std::vector<Eigen::Vector3f> dynamicCells() const override {
    return cellCenters(grid_.window(), knows_ ? grid_.newVoxels() : std::vector<Index3>());
  }

  std::vector<EchoReason> reasons() const override {
    std::vector<EchoReason> reasons(judged_.dynamic.size(), EchoReason::kOutside);
    for (std::size_t i = 0; i < reasons.size(); ++i) {
      if (judged_.observed[i] != 0) reasons[i] = judged_.dynamic[i] != 0 ? EchoReason::kMoving : EchoReason::kSettled;
    }
    for (const std::uint32_t echo : grid_.noEchoes()) {
      if (echo < reasons.size()) reasons[echo] = EchoReason::kNoEcho;
    }
    return reasons;
  }

  MemoryCells memoryCells() const override {
    MemoryCells cells;
    const GridWindow& window = grid_.window();
    std::vector<Index3> remembered = rememberedBy(grid_);
    std::sort(remembered.begin(), remembered.end(), isBefore);
    // Before the cloud there were all of these: what was not forgotten was hit, or is in the shadow.
    for (const Index3& voxel : before_) {
      const Eigen::Vector3f center = (window.odomFromGrid() * window.indexToCenter(voxel)).cast<float>();
      const bool stays = std::binary_search(remembered.begin(), remembered.end(), voxel, isBefore);
      const bool is_hit = std::binary_search(hit_.begin(), hit_.end(), voxel, isBefore);
      if (!stays) {
        cells.seen_through.push_back(center);
      } else if (!is_hit) {
        cells.shadowed.push_back(center);
      }
    }
    return cells;
  }

  void watch(bool watched) override {
    watched_ = watched;
    before_.clear();
  }

  std::size_t cloudsPerTurn() const override { return turns_.cloudsPerTurn(); }

  GridOutline outline() const override { return grid_.window().outline(); }

  std::size_t memoryBytes() const override {
    return grid_.memoryBytes() + turns_.memoryBytes() + judged_.dynamic.capacity() + judged_.observed.capacity();
  }

 private:
  void beginTurn(const Eigen::Isometry3d& odom_from_base) {
    knows_ = has_turn_;
    has_turn_ = true;
    grid_.beginTurn(odom_from_base);
  }

  Grid grid_;
  StreamGuard guard_;
  SampledTurns turns_;
  EchoLabels judged_;
  std::vector<Object> no_objects_;
  bool has_turn_ = false;
  bool knows_ = false;  ///< the last cloud was judged against a turn before its own
  bool watched_ = false;
  std::vector<Index3> before_, hit_;  ///< of the last cloud, in its window; only while watched
};

}  // namespace

std::unique_ptr<Detector> makePaperDetector3d(const Config& config) {
  return std::make_unique<PaperDetector<Grid3d<RayIndex>>>(config);
}
std::unique_ptr<Detector> makeZBufferDetector(const Config& config) {
  return std::make_unique<PaperDetector<Grid3d<ZBuffer>>>(config);
}
std::unique_ptr<Detector> makePaperDetector2d(const Config& config) {
  return std::make_unique<PaperDetector<Grid2d>>(config);
}

double paperBytes3d(const Config& config, double echoes) {
  const double bricks = (GridWindow::extentOf(config) / GridWindow::kBrick).prod();
  return VoxelMemory::bytesFor(bricks, echoes, config.threads) + RayIndex::bytesFor(echoes, config.threads) +
         SampledTurns::bytesFor(echoes) + kKeptLabels * echoes;
}
double paperBytes2d(const Config& config, double echoes) {
  const double cells = GridWindow::extentOf(config).head<2>().prod();
  return Grid2d::bytesFor(cells, echoes, config.threads) + SampledTurns::bytesFor(echoes) + kKeptLabels * echoes;
}

}  // namespace donex
