#include "paper_detectors.h"

#include "donex/core/grid_2d.h"
#include "donex/core/grid_3d.h"
#include "donex/core/stream_guard.h"

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
  void update();

  Grid grid_;
  StreamGuard guard_;
  GridScan scan_;
  std::vector<std::uint8_t> dynamic_;
  std::vector<Object> no_objects_;
  bool is_first_ = true;
};

template <>
bool PaperDetector<Grid3d>::isRemembered(const Eigen::Vector3f& echo) const {
  return grid_.remembers(voxelOf(echo));
}

template <>
void PaperDetector<Grid3d>::update() {
  grid_.hit(scan_);
  grid_.deshadow(scan_);
  grid_.remember();
}

template <>
bool PaperDetector<Grid2d>::isRemembered(const Eigen::Vector3f& echo) const {
  return grid_.remembers(echo);
}

template <>
void PaperDetector<Grid2d>::update() {
  grid_.resize(scan_);
}

}  // namespace

std::unique_ptr<Detector> makePaperDetector3d(const Config& config) {
  return std::make_unique<PaperDetector<Grid3d>>(config);
}
std::unique_ptr<Detector> makePaperDetector2d(const Config& config) {
  return std::make_unique<PaperDetector<Grid2d>>(config);
}

}  // namespace donex
