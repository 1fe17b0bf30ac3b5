// What the methods of the comparison share: the region of interest, and what the interface asks beside labels.
#pragma once

#include "core/grid/grid_window.h"
#include "core/methods/stream_guard.h"
#include "donex/detector.h"

namespace donex {

/// A method says only which echoes of a scan are dynamic; the region is the window's of all methods.
template <class Interface>
class ComparisonDetector : public Interface {
 public:
  void process(const Scan& scan, EchoLabels& labels) override {
    guard_.admit(scan);
    window_.moveTo(scan.odom_from_base);
    window_.enter(scan, in_grid_);
    labels.assign(scan.echoes.size());
    judge(scan, in_grid_, labels);
    dynamic_ = labels.dynamic;
  }

  void reset() override {
    guard_.reset();
    dynamic_.clear();
    forget();
  }

  const std::vector<Object>& objects() const override { return no_objects_; }
  std::vector<Eigen::Vector3f> dynamicCells() const override { return cellCenters(window_, in_grid_, dynamic_); }
  GridOutline outline() const override { return window_.outline(); }

  std::size_t memoryBytes() const override {
    return in_grid_.echoes.capacity() * sizeof(Eigen::Vector3f) + in_grid_.inside.capacity() + dynamic_.capacity() +
           methodBytes();
  }

 protected:
  explicit ComparisonDetector(const Config& config) : window_(config.scrolling()) {}

  /// Marks what is dynamic and what was observed; labels come all 0.
  virtual void judge(const Scan& scan, const GridScan& in_grid, EchoLabels& labels) = 0;
  virtual void forget() = 0;
  virtual std::size_t methodBytes() const = 0;

  const GridWindow& window() const { return window_; }
  /// Of the following stream, after a reset of the guard alone.
  StreamGuard& guard() { return guard_; }

 private:
  GridWindow window_;
  StreamGuard guard_;
  GridScan in_grid_;
  std::vector<std::uint8_t> dynamic_;
  std::vector<Object> no_objects_;
};

}  // namespace donex
