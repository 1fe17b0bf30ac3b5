// The motion voxel grid, after Asvadi, Premebida, Peixoto & Nunes, "3D Lidar-based static and moving obstacle detection
// in driving environments: An approach based on voxels and multi-region ground planes", Robotics and Autonomous Systems
// 83 (2016). Ground is what lies on the planes of the regions (section 3); the other echoes are voxels with two
// counters over the last scans, in the odometry frame (section 4): how often something was there (static, smoothed by a
// Gaussian against the grid's steps) and how often it was seen free (dynamic). Where the logarithm of their ratio is
// above a threshold, the voxel moves. The constants are ours.
#include <bitset>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "core/grid/voxel_key.h"
#include "core/methods/comparison_detector.h"
#include "core/methods/detectors.h"
#include "core/methods/region_planes.h"
#include "core/sight/sight_history.h"

namespace donex {
namespace {

constexpr int kCountedScans = 10;      // over which the counters run
constexpr float kGround = 0.25F;       // above a region's plane an echo belongs to an obstacle [m]
constexpr double kNeighbour = 0.6065;  // a Gaussian of one voxel, one voxel away
constexpr double kLeastRatio = 0.0;    // of the counters, as a logarithm: more often free than occupied
constexpr double kHistory = 0.95;      // the sights that are kept [s]: ten scans of a 10 Hz sensor
constexpr double kSpacing = 0.09;      // [s]

class MotionVoxelGridDetector : public ComparisonDetector<Detector> {
 public:
  explicit MotionVoxelGridDetector(const Config& config)
      : ComparisonDetector(config), sights_(kHistory, kSpacing, static_cast<float>(config.voxel_size), {false, 0.0}) {}

 protected:
  void judge(const Scan& scan, const GridScan& in_grid, EchoLabels& labels) override {
    ++scan_;
    placePoints(window(), in_grid, points_, is_echo_);
    ground_.fit(in_grid.origin * static_cast<float>(window().voxelSize()), points_, is_echo_);
    const SightView before = sights_.seenFrom(window().odomFromWindow());
    std::unordered_map<VoxelKey, bool, VoxelHash> verdicts;
    for (std::size_t i = 0; i < labels.dynamic.size(); ++i) {
      const bool is_obstacle = in_grid.inside[i] != 0 && ground_.heightOf(points_[i]) > kGround;
      labels.observed[i] = in_grid.inside[i];
      if (!is_obstacle) continue;
      const Index3 voxel = voxelOf(in_grid.echoes[i]);
      const auto [verdict, is_first] = verdicts.try_emplace(keyOf(voxel + window().minIndex()), false);
      if (is_first) verdict->second = moves(voxel, before);
      labels.dynamic[i] = verdict->second ? 1 : 0;
    }
    for (const auto& verdict : verdicts) count(verdict.first);
    sights_.arrive(scan, is_echo_);
    sights_.add(scan, is_echo_);
    forgetOld();
  }

  void forget() override {
    hits_.clear();
    sights_.reset();
  }

  std::size_t methodBytes() const override {
    constexpr std::size_t kNode = sizeof(Hits) + sizeof(VoxelKey) + 2 * sizeof(void*);
    return sights_.memoryBytes() + hits_.size() * kNode + points_.capacity() * sizeof(Eigen::Vector3f);
  }

 private:
  /// In which of the last scans a voxel was hit: bit j, `last_scan` - j.
  struct Hits {
    std::int64_t last_scan = 0;
    std::uint32_t bits = 0;
  };

  double hitsOf(const Index3& voxel) const {
    const auto found = hits_.find(keyOf(voxel));
    if (found == hits_.end()) return 0.0;
    const std::int64_t age = scan_ - found->second.last_scan;
    constexpr std::uint64_t kWindow = (std::uint64_t{1} << kCountedScans) - 1U;
    if (age >= kCountedScans) return 0.0;
    return static_cast<double>(std::bitset<64>(std::uint64_t{found->second.bits} << age & kWindow).count());
  }

  bool moves(const Index3& in_window, const SightView& before) const {
    const Index3 voxel = in_window + window().minIndex();
    double fixed = hitsOf(voxel);
    for (int axis = 0; axis < 3; ++axis) {
      fixed += kNeighbour * (hitsOf(voxel + Index3::Unit(axis)) + hitsOf(voxel - Index3::Unit(axis)));
    }
    const Eigen::Vector3f center = (in_window.cast<float>().array() + 0.5F) * static_cast<float>(window().voxelSize());
    const double dynamic = before.ask(center, -std::numeric_limits<double>::infinity(), kCountedScans).free;
    return std::log((dynamic + 1.0) / (fixed + 1.0)) > kLeastRatio;
  }

  void count(VoxelKey key) {
    Hits& hits = hits_[key];
    const std::int64_t age = scan_ - hits.last_scan;
    hits.bits = (age < kCountedScans ? hits.bits << age : 0U) | 1U;
    hits.last_scan = scan_;
  }

  void forgetOld() {
    if (scan_ % kCountedScans != 0) return;
    for (auto hits = hits_.begin(); hits != hits_.end();) {
      hits = scan_ - hits->second.last_scan >= kCountedScans ? hits_.erase(hits) : std::next(hits);
    }
  }

  std::int64_t scan_ = 0;
  SightHistory sights_;
  RegionPlanes ground_;
  std::unordered_map<VoxelKey, Hits, VoxelHash> hits_;  ///< by voxel of the odometry frame
  std::vector<Eigen::Vector3f> points_;                 ///< in the grid's window [m]
  std::vector<std::uint8_t> is_echo_;
};

}  // namespace

std::unique_ptr<Detector> makeMotionVoxelGridDetector(const Config& config) {
  return std::make_unique<MotionVoxelGridDetector>(config);
}

}  // namespace donex
