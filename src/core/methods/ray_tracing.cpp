// Ray tracing with evidence, after Lee, Kim & Jo, "Rapid Motion Segmentation of LiDAR Point Cloud Based on a
// Combination of Probabilistic and Evidential Approaches for Intelligent Vehicles", Sensors 2019, 19, 4116.
// An echo is looked up in the mesh of an earlier scan. On its surface it is static, before it (where the earlier scan
// saw through) dynamic, with a probability from the beam's uncertainty; behind it, or where the mesh has no surface,
// that scan says little. Where the newest scan leaves the echo unknown, earlier ones are combined with it by
// Dempster's rule. The constants are ours: the publication's belong to its own sensor.
#include <cmath>
#include <deque>

#include "core/methods/comparison_detector.h"
#include "core/methods/detectors.h"
#include "core/methods/motion_belief.h"
#include "core/methods/scan_mesh.h"
#include "core/pi.h"

namespace donex {
namespace {

constexpr std::size_t kAskedScans = 5;    // earlier scans that may be asked
constexpr double kReliability = 0.9;      // of what a surface says
constexpr double kEdgeReliability = 0.4;  // of what the corners on both sides of a step in depth say
constexpr double kKnown = 0.5;            // the mass that must be known for a decision
constexpr float kRangeNoise = 0.06F;      // of sensor and odometry together [m]
constexpr float kBeam = 0.0015F;          // half the divergence of a beam [rad]

/// Standard deviation of the range at which a beam meets a surface: a tilted one spreads over the beam's width.
float uncertaintyOf(const ScanMesh::Surface& surface) {
  const float cosine = std::max(surface.cosine, 0.01F);
  const float tangent = std::sqrt(std::max(1.0F - cosine * cosine, 0.0F)) / cosine;
  return std::hypot(kRangeNoise, kBeam * surface.range * tangent);
}

/// The belief that the mesh gives for a point `range` away.
MotionBelief beliefOf(const ScanMesh::Surface& surface, float range) {
  const double off = (range - surface.range) / (surface.is_edge ? kRangeNoise : uncertaintyOf(surface));
  const double on_surface = std::exp(-0.5 * off * off);
  const double in_front = off < 0.0 ? 1.0 - on_surface : 0.0;
  if (!surface.is_edge) return {kReliability * in_front, kReliability * on_surface};
  const double far_off = (range - surface.far_range) / kRangeNoise;
  const double on_corner = std::max(on_surface, std::exp(-0.5 * far_off * far_off));
  return {kEdgeReliability * in_front, kEdgeReliability * on_corner * (1.0 - in_front)};
}

class RayTracingDetector : public ComparisonDetector<Detector> {
 public:
  explicit RayTracingDetector(const Config& config)
      : ComparisonDetector(config), largest_gap_(config.evidence.sight_gap * kPi / 180.0) {}

 protected:
  void judge(const Scan& scan, const GridScan& in_grid, EchoLabels& labels) override {
    const Eigen::Isometry3d odom_from_sensor = scan.odomFromSensor();
    for (EarlierScan& earlier : earlier_) {
      earlier.earlier_from_sensor = (earlier.sensor_from_odom * odom_from_sensor).cast<float>();
    }
    for (std::size_t i = 0; i < scan.echoes.size(); ++i) {
      if (in_grid.inside[i] == 0) continue;
      const MotionBelief belief = beliefOfEcho(scan.echoes[i]);
      labels.observed[i] = 1.0 - belief.unknown() > kKnown ? 1 : 0;
      labels.dynamic[i] = belief.dynamic > kKnown ? 1 : 0;
    }
    keep(scan);
  }

  void forget() override { earlier_.clear(); }
  std::size_t methodBytes() const override {
    std::size_t bytes = 0;
    for (const EarlierScan& earlier : earlier_) bytes += sizeof(EarlierScan) + earlier.mesh.memoryBytes();
    return bytes;
  }

 private:
  struct EarlierScan {
    Eigen::Isometry3d sensor_from_odom;
    Eigen::Isometry3f earlier_from_sensor;
    ScanMesh mesh;
  };

  /// What the earlier scans say, the newest first.
  MotionBelief beliefOfEcho(const Eigen::Vector3f& echo) const {
    MotionBelief belief;
    for (const EarlierScan& earlier : earlier_) {
      const Eigen::Vector3f point = earlier.earlier_from_sensor * echo;
      const auto surface = earlier.mesh.at(point);
      if (surface) belief = belief.combinedWith(beliefOf(*surface, point.norm()));
      if (1.0 - belief.unknown() > kKnown) break;
    }
    return belief;
  }

  void keep(const Scan& scan) {
    if (earlier_.size() == kAskedScans) {
      earlier_.push_front(std::move(earlier_.back()));  // its mesh's storage is used again
      earlier_.pop_back();
    } else {
      earlier_.push_front({{}, {}, ScanMesh(largest_gap_)});
    }
    earlier_.front().sensor_from_odom = scan.odomFromSensor().inverse();
    earlier_.front().mesh.build(scan.echoes);
  }

  double largest_gap_;               // [rad]
  std::deque<EarlierScan> earlier_;  ///< newest first
};

}  // namespace

std::unique_ptr<Detector> makeRayTracingDetector(const Config& config) {
  return std::make_unique<RayTracingDetector>(config);
}

}  // namespace donex
