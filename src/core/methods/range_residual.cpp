// The residual image without learning: the baseline that the learned methods start from.
// Chen et al., "Moving Object Segmentation in 3D LiDAR Data: A Learning-based Approach Exploiting Sequential Data",
// RA-L 2021, section III-C: the last scan is moved into the present sensor frame and projected; an echo's residual is
// |r - r'| / r, with r' the range of the last scan in its pixel. Here the residual is compared with a threshold.
#include <cmath>

#include "core/methods/comparison_detector.h"
#include "core/methods/detectors.h"
#include "core/sight/range_image.h"

namespace donex {
namespace {

constexpr float kThreshold = 0.05F;  // ours: the publication has a network learn what a residual means

class RangeResidualDetector : public ComparisonDetector<Detector> {
 public:
  explicit RangeResidualDetector(const Config& config) : ComparisonDetector(config) {}

 protected:
  void judge(const Scan& scan, const GridScan& in_grid, EchoLabels& labels) override {
    const Eigen::Isometry3d odom_from_sensor = scan.odomFromSensor();
    project((odom_from_sensor.inverse() * odom_from_last_).cast<float>());
    for (std::size_t i = 0; i < scan.echoes.size(); ++i) {
      if (in_grid.inside[i] == 0) continue;
      const float last = image_.rangeTowards(scan.echoes[i]);
      if (last == 0.0F) continue;
      const float range = scan.echoes[i].norm();
      labels.observed[i] = 1;
      labels.dynamic[i] = std::abs(range - last) / range > kThreshold ? 1 : 0;
    }
    last_ = scan.echoes;
    odom_from_last_ = odom_from_sensor;
  }

  void forget() override { last_.clear(); }
  std::size_t methodBytes() const override { return image_.memoryBytes() + last_.capacity() * sizeof(Eigen::Vector3f); }

 private:
  void project(const Eigen::Isometry3f& sensor_from_last) {
    image_.clear();
    for (const Eigen::Vector3f& echo : last_) {
      const bool is_echo = echo.squaredNorm() <= kFarthestEcho * kFarthestEcho;  // false for NaN
      if (is_echo) image_.add(sensor_from_last * echo);
    }
  }

  RangeImage image_;
  std::vector<Eigen::Vector3f> last_;  ///< in the last scan's sensor frame [m]
  Eigen::Isometry3d odom_from_last_ = Eigen::Isometry3d::Identity();
};

}  // namespace

std::unique_ptr<Detector> makeRangeResidualDetector(const Config& config) {
  return std::make_unique<RangeResidualDetector>(config);
}

}  // namespace donex
