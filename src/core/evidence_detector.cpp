#include "evidence_detector.h"

#include <algorithm>
#include <cmath>

#include "donex/core/clusters.h"
#include "donex/core/ground.h"
#include "donex/core/newness.h"
#include "donex/core/object_tracker.h"
#include "donex/core/stream_guard.h"

namespace donex {
namespace {

constexpr float kSkirt = 0.1F;  // [m] echoes from here up to the ground clearance belong to the object above them

double reachOf(const Region& r) {
  return std::hypot(std::max(-r.x_min, r.x_max), std::max(-r.y_min, r.y_max));
}

SightHistory makeHistory(const EvidenceConfig& e) {
  constexpr double kSpacing = 0.1;  // [s]
  constexpr double kRadians = 3.14159265358979 / 180.0;
  return SightHistory(e.history_length, kSpacing, static_cast<float>(e.sight_margin),
                      {e.careful_sight, std::tan(e.sight_gap * kRadians)});
}

/// What both grids share; `Newness` is what differs between them.
template <class Newness>
class EvidenceDetector : public Detector {
 public:
  explicit EvidenceDetector(const Config& config)
      : config_(config),
        newness_(config),
        clock_(config.evidence.birth_age ? config.evidence.birth_window : 0.0),
        history_(makeHistory(config.evidence)),
        ground_(reachOf(config.region)),
        clusters_(reachOf(config.region), {config.objects.cell, config.objects.height, 0.01, 0.015}),
        fine_clusters_(reachOf(config.region), {0.5 * config.objects.cell, config.objects.height, 0.01, 0.015}),
        tracker_(config.objects) {}

  void process(const Scan& scan, EchoLabels& labels) override {
    guard_.admit(scan);
    clock_.begin(scan.stamp);
    newness_.shift(scan.odom_from_base);   // voxel shift (paper, "Ego motion")
    newness_.window().enter(scan, scan_);
    placePoints();
    estimateGround();
    history_.askFrom(odomFromPoints());
    judgePlaces();                         // free evidence, birth age, neighbourhood
    history_.add(scan, is_echo_);
    history_.askFrom(odomFromPoints());
    labelPlaces(labels);
    if (config_.objects.enabled) labelObjects(scan.stamp, labels);
    dynamic_ = labels.dynamic;
  }

  void reset() override {
    newness_.reset();
    guard_.reset();
    clock_.reset();
    history_.reset();
    tracker_.reset();
    dynamic_.clear();
  }

  const std::vector<Object>& objects() const override { return tracker_.objects(); }

  std::vector<Eigen::Vector3f> dynamicCells() const override {
    return cellCenters(newness_.window(), scan_, dynamic_);
  }

  GridOutline outline() const override { return newness_.window().outline(); }

  std::size_t memoryBytes() const override {
    return newness_.memoryBytes() + history_.memoryBytes() + ground_.memoryBytes() + clusters_.memoryBytes() +
           tracker_.memoryBytes() + points_.capacity() * 3 * sizeof(Eigen::Vector3f);
  }

 private:
  /// Points are the scan's echoes in the window, in metres.
  Eigen::Isometry3d odomFromPoints() const {
    const GridWindow& window = newness_.window();
    const Eigen::Vector3d corner = window.minIndex().template cast<double>() * window.voxelSize();
    return window.odomFromGrid() * Eigen::Translation3d(corner);
  }

  void placePoints() {
    const auto size = static_cast<float>(config_.voxel_size);
    points_.resize(scan_.echoes.size());
    is_echo_.resize(scan_.echoes.size());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      points_[i] = scan_.echoes[i] * size;
      is_echo_[i] = std::isnan(points_[i].x()) ? 0 : 1;
    }
    sensor_ = scan_.origin * size;
  }

  void estimateGround() {
    heights_.resize(points_.size());
    if (config_.evidence.ground) ground_.estimate(sensor_, points_, is_echo_);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      heights_[i] = config_.evidence.ground ? ground_.heightOf(points_[i]) : points_[i].z();
    }
  }

  bool isGround(std::size_t echo) const {
    return config_.evidence.ground && heights_[echo] <= static_cast<float>(config_.evidence.ground_clearance);
  }

  void judgePlaces() {
    places_.assign(points_.size(), Place::kUnobserved);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (scan_.inside[i] == 0 || isGround(i)) continue;
      places_[i] = newness_.judge(scan_.echoes[i], points_[i], clock_, history_);
    }
  }

  void labelPlaces(EchoLabels& labels) const {
    labels.assign(points_.size());
    if (clock_.scan() == 1) return;  // nothing is known yet
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (scan_.inside[i] == 0) continue;
      labels.observed[i] = isGround(i) || places_[i] != Place::kUnobserved;
      labels.dynamic[i] = !config_.objects.enabled && places_[i] == Place::kNew;
    }
  }

  void labelObjects(double stamp, EchoLabels& labels) {
    gatherCandidates();
    tracker_.update(stamp, points_, odomFromPoints(), history_, candidates_);
    for (const Candidate& candidate : candidates_) {
      if (!candidate.dynamic) continue;
      for (const std::uint32_t echo : candidate.echoes) labels.dynamic[echo] = labels.observed[echo] = 1;
    }
    releaseNeighbours(labels);
  }

  /// What stands so close to a moving thing that both are one cluster: looked at with a finer eye, a part
  /// without a new echo is let go where it is settled, or larger than all that is new.
  void releaseNeighbours(EchoLabels& labels) {
    bool any = false;
    std::fill(members_.begin(), members_.end(), Clusters::kOut);
    for (const Candidate& candidate : candidates_) {
      if (!candidate.dynamic || candidate.new_echoes == 0) continue;
      any = true;
      for (const std::uint32_t echo : candidate.echoes) {
        members_[echo] = isGround(echo) ? Clusters::kSkirt : Clusters::kIn;
      }
    }
    if (!any) return;
    fine_clusters_.connect(sensor_, points_, heights_, members_);
    parts_.assign(static_cast<std::size_t>(fine_clusters_.count()), Part{});
    for (const Candidate& candidate : candidates_) {
      if (!candidate.dynamic || candidate.new_echoes == 0) continue;
      for (const std::uint32_t echo : candidate.echoes) {
        if (fine_clusters_.of(echo) == Clusters::kNone) continue;
        Part& part = parts_[static_cast<std::size_t>(fine_clusters_.of(echo))];
        ++part.echoes;
        part.is_new = part.is_new || places_[echo] == Place::kNew;
        part.settled += places_[echo] == Place::kSettled ? 1 : 0;
      }
      int largest_new = 0;
      for (const std::uint32_t echo : candidate.echoes) {
        if (fine_clusters_.of(echo) == Clusters::kNone) continue;
        const Part& part = parts_[static_cast<std::size_t>(fine_clusters_.of(echo))];
        if (part.is_new) largest_new = std::max(largest_new, part.echoes);
      }
      for (const std::uint32_t echo : candidate.echoes) {
        if (fine_clusters_.of(echo) == Clusters::kNone) continue;
        const Part& part = parts_[static_cast<std::size_t>(fine_clusters_.of(echo))];
        const bool other = !part.is_new && (2 * part.settled > part.echoes || part.echoes > largest_new);
        if (other) labels.dynamic[echo] = 0;
      }
    }
  }

  /// Clusters; where only a part of one is new (a pedestrian at a wall), its parts that are not settled.
  void gatherCandidates() {
    candidates_.clear();
    members_.resize(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) members_[i] = membershipOf(i);
    clusters_.connect(sensor_, points_, heights_, members_);
    addCandidates();
    bool any_mixed = false;
    std::fill(members_.begin(), members_.end(), Clusters::kOut);
    for (Candidate& candidate : candidates_) {
      const bool is_mixed = candidate.new_echoes >= config_.objects.min_echoes && !tracker_.isNew(candidate);
      if (!is_mixed) continue;
      any_mixed = true;
      for (const std::uint32_t echo : candidate.echoes) {
        if (places_[echo] != Place::kSettled && !isGround(echo)) members_[echo] = Clusters::kIn;
      }
      candidate.echoes.clear();
    }
    if (!any_mixed) return;
    clusters_.connect(sensor_, points_, heights_, members_);
    addCandidates();
    const auto is_gone = [](const Candidate& candidate) { return candidate.echoes.empty(); };
    candidates_.erase(std::remove_if(candidates_.begin(), candidates_.end(), is_gone), candidates_.end());
  }

  std::uint8_t membershipOf(std::size_t echo) const {
    if (scan_.inside[echo] == 0) return Clusters::kOut;
    if (!isGround(echo)) return Clusters::kIn;
    return heights_[echo] > kSkirt ? Clusters::kSkirt : Clusters::kOut;
  }

  void addCandidates() {
    const std::size_t first = candidates_.size();
    candidates_.resize(first + static_cast<std::size_t>(clusters_.count()));
    const Eigen::Isometry3d odom_from_points = odomFromPoints();
    const Eigen::Vector3d infinity = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (clusters_.of(i) == Clusters::kNone) continue;
      Candidate& candidate = candidates_[first + static_cast<std::size_t>(clusters_.of(i))];
      if (candidate.echoes.empty()) candidate.low = infinity, candidate.high = -infinity;
      candidate.echoes.push_back(static_cast<std::uint32_t>(i));
      candidate.new_echoes += places_[i] == Place::kNew ? 1 : 0;
      candidate.settled_echoes += places_[i] == Place::kSettled ? 1 : 0;
      const Eigen::Vector3d point = odom_from_points * points_[i].cast<double>();
      candidate.low = candidate.low.cwiseMin(point);
      candidate.high = candidate.high.cwiseMax(point);
    }
    const auto is_small = [&](const Candidate& candidate) {
      return candidate.echoes.size() < static_cast<std::size_t>(config_.objects.min_echoes);
    };
    candidates_.erase(
        std::remove_if(candidates_.begin() + static_cast<std::ptrdiff_t>(first), candidates_.end(), is_small),
        candidates_.end());
  }

  Config config_;
  StreamGuard guard_;
  Newness newness_;
  ScanClock clock_;
  SightHistory history_;
  Ground ground_;
  Clusters clusters_, fine_clusters_;
  ObjectTracker tracker_;

  GridScan scan_;
  Eigen::Vector3f sensor_ = Eigen::Vector3f::Zero();
  std::vector<Eigen::Vector3f> points_;
  std::vector<std::uint8_t> is_echo_, members_, dynamic_;
  std::vector<float> heights_;
  std::vector<Place> places_;
  std::vector<Candidate> candidates_;
  struct Part { int echoes = 0, settled = 0; bool is_new = false; };
  std::vector<Part> parts_;
};

}  // namespace

std::unique_ptr<Detector> makeEvidenceDetector3d(const Config& config) {
  return std::make_unique<EvidenceDetector<Newness3d>>(config);
}
std::unique_ptr<Detector> makeEvidenceDetector2d(const Config& config) {
  return std::make_unique<EvidenceDetector<Newness2d>>(config);
}

}  // namespace donex
