#include <algorithm>
#include <cmath>

#include "core/evidence/ground.h"
#include "core/evidence/newness.h"
#include "core/grid/storage.h"
#include "core/methods/detectors.h"
#include "core/methods/stream_guard.h"
#include "core/objects/candidate_finder.h"
#include "core/objects/object_tracker.h"
#include "core/pi.h"

namespace donex {
namespace {

constexpr float kSkirt = 0.07F;             // [m] from here up to the ground clearance echoes may belong to an object
constexpr std::size_t kExpectedAhead = 12;  // echoes; long enough for memory to answer
constexpr double kHistorySpacing = 0.09;    // [s] a 10 Hz sensor's every scan, a 20 Hz sensor's every second

SightHistory historyOf(const EvidenceConfig& e) {
  constexpr double kRadians = kPi / 180.0;
  return SightHistory(e.history_length, kHistorySpacing, static_cast<float>(e.sight_margin),
                      {e.careful_sight, std::tan(e.sight_gap * kRadians)});
}

/// What both grids share; `Newness` is what differs between them.
template <class Newness>
class EvidenceDetector : public Detector {
 public:
  explicit EvidenceDetector(const Config& config)
      : config_(config),
        newness_(config.scrolling()),  // births are times, which resampling would blur
        clock_(config.evidence.birth_age ? config.evidence.birth_window : 0.0),
        history_(historyOf(config.evidence)),
        ground_(reachOf(config.region)),
        finder_(reachOf(config.region), config.objects),
        tracker_(config.objects) {}

  void process(const Scan& scan, EchoLabels& labels) override {
    guard_.admit(scan);
    clock_.begin(scan.stamp);
    newness_.shift(scan.odom_from_base);  // voxel shift (paper, "Ego motion")
    newness_.window().enter(scan, scan_);
    place(scan.stamp);
    findGround();   // algorithm: "Ground"
    judgePlaces();  // asked of the scans before this one
    history_.add(scan, judged_.is_echo);
    history_.askFrom(judged_.odom_from_points);
    labelPlaces(labels);
    if (config_.objects.enabled) labelObjects(labels);
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

  std::vector<Eigen::Vector3f> dynamicCells() const override { return cellCenters(newness_.window(), scan_, dynamic_); }

  std::vector<EchoReason> reasons() const override {
    std::vector<EchoReason> reasons(dynamic_.size());
    for (std::size_t i = 0; i < reasons.size(); ++i) reasons[i] = reasonOf(i);
    return reasons;
  }

  MemoryCells memoryCells() const override { return cellsOf(newness_); }

  GridOutline outline() const override { return newness_.window().outline(); }

  std::size_t memoryBytes() const override {
    const std::size_t in_grid = scan_.echoes.capacity() * sizeof(Eigen::Vector3f) + scan_.inside.capacity();
    const std::size_t judged = judged_.points.capacity() * sizeof(Eigen::Vector3f) +
                               judged_.heights.capacity() * sizeof(float) + judged_.is_echo.capacity() +
                               judged_.standing.capacity() + judged_.places.capacity() + dynamic_.capacity();
    return in_grid + judged + newness_.memoryBytes() + history_.memoryBytes() + ground_.memoryBytes() +
           finder_.memoryBytes() + tracker_.memoryBytes() + candidates_.memoryBytes();
  }

 private:
  void place(double stamp) {
    const GridWindow& window = newness_.window();
    judged_.stamp = stamp;
    judged_.odom_from_points = window.odomFromWindow();
    judged_.sensor = scan_.origin * static_cast<float>(window.voxelSize());
    placePoints(window, scan_, judged_.points, judged_.is_echo);
  }

  void findGround() {
    const bool enabled = config_.evidence.ground;
    const auto clearance = static_cast<float>(config_.evidence.ground_clearance);
    resizeTo(judged_.heights, judged_.points.size());
    if (enabled) {
      ground_.estimate(judged_.sensor, judged_.points, judged_.is_echo);
      ground_.heightsOf(judged_.points, judged_.heights);
    }
    judged_.standing.assign(judged_.points.size(), Standing::kOut);
    for (std::size_t i = 0; i < judged_.points.size(); ++i) {
      // Without the step there is no ground to stand above: heights are the window's.
      if (!enabled) judged_.heights[i] = judged_.points[i].z();
      const float height = judged_.heights[i];
      if (scan_.inside[i] == 0) continue;
      const bool is_above = !enabled || height > clearance;
      if (is_above) {
        judged_.standing[i] = Standing::kIn;
      } else if (height > kSkirt) {
        judged_.standing[i] = Standing::kSkirt;
      }
    }
  }

  void judgePlaces() {
    history_.askFrom(judged_.odom_from_points);
    judged_.places.assign(judged_.points.size(), Place::kUnobserved);
    for (std::size_t i = 0; i < judged_.points.size(); ++i) {
      const std::size_t later = i + kExpectedAhead;
      const bool will_be_asked = later < judged_.points.size() && judged_.standing[later] == Standing::kIn;
      if (will_be_asked) newness_.expect(scan_.echoes[later]);
      if (judged_.standing[i] != Standing::kIn) continue;
      judged_.places[i] = newness_.judge(scan_.echoes[i], judged_.points[i], clock_, history_);
    }
  }

  void labelPlaces(EchoLabels& labels) const {
    labels.assign(judged_.points.size());
    if (clock_.scan() == 1) return;  // nothing is known yet
    for (std::size_t i = 0; i < judged_.points.size(); ++i) {
      if (scan_.inside[i] == 0) continue;
      const bool is_ground = judged_.standing[i] != Standing::kIn;
      labels.observed[i] = is_ground || judged_.places[i] != Place::kUnobserved;
      labels.dynamic[i] = !config_.objects.enabled && judged_.places[i] == Place::kNew;
    }
  }

  void labelObjects(EchoLabels& labels) {
    finder_.find(judged_, tracker_.expect(judged_.stamp), candidates_);
    tracker_.update(judged_, history_, candidates_);
    finder_.release(judged_, candidates_);
    for (const Candidate& candidate : candidates_) {
      if (!candidate.dynamic) continue;
      for (const std::uint32_t echo : candidate.echoes) labels.dynamic[echo] = labels.observed[echo] = 1;
    }
  }

  EchoReason reasonOf(std::size_t i) const {
    if (dynamic_[i] != 0) return EchoReason::kMoving;
    if (judged_.is_echo[i] == 0) return EchoReason::kNoEcho;
    if (scan_.inside[i] == 0) return EchoReason::kOutside;
    if (judged_.standing[i] != Standing::kIn) return EchoReason::kGround;
    switch (judged_.places[i]) {
      case Place::kNew: return EchoReason::kNewAlone;
      case Place::kAtSurface:
      case Place::kSettled: return EchoReason::kSettled;
      case Place::kUnobserved: break;
    }
    return EchoReason::kUnobserved;
  }

  /// De-shadowing is asked only where something is hit again; here it is asked of every voxel that is not hit.
  MemoryCells cellsOf(const Newness3d& newness) const {
    MemoryCells cells;
    const auto size = static_cast<float>(newness.window().voxelSize());
    newness.memory().forEach([&](const Index3& voxel, const VoxelRecord& record) {
      if (record.last_hit == clock_.scan()) return;
      const Eigen::Vector3f point = (voxel.cast<float>().array() + 0.5F) * size;
      const bool settled = !clock_.isYoung(record.birth, record.was_free);
      const double since = clock_.stampOf(record.last_hit);
      auto& kind =
          wasFree(config_.evidence, history_, point, since, true, settled) ? cells.seen_through : cells.shadowed;
      kind.emplace_back((judged_.odom_from_points * point.cast<double>()).cast<float>());
    });
    return cells;
  }
  MemoryCells cellsOf(const Newness2d&) const { return {}; }

  Config config_;
  StreamGuard guard_;
  Newness newness_;
  ScanClock clock_;
  SightHistory history_;
  Ground ground_;
  CandidateFinder finder_;
  ObjectTracker tracker_;

  GridScan scan_;
  JudgedScan judged_;
  Candidates candidates_;
  std::vector<std::uint8_t> dynamic_;
};

}  // namespace

std::unique_ptr<Detector> makeEvidenceDetector3d(const Config& config) {
  return std::make_unique<EvidenceDetector<Newness3d>>(config);
}
std::unique_ptr<Detector> makeEvidenceDetector2d(const Config& config) {
  return std::make_unique<EvidenceDetector<Newness2d>>(config);
}

double evidenceBytes(const Config& config, double echoes) {
  constexpr double kInGrid = sizeof(Eigen::Vector3f) + 1.0;  // place and inside
  constexpr double kJudged = sizeof(Eigen::Vector3f) + sizeof(float) + 1.0;
  constexpr double kVerdict = sizeof(Standing) + sizeof(Place) + 1.0;
  constexpr double kThings = 20.0;  // bytes an echo, about: candidates, tracks and their traces
  const double reach = reachOf(config.region);
  const Eigen::Vector3d extent = GridWindow::extentOf(config.scrolling());
  double bytes = roomFor((kInGrid + kJudged) * echoes) + kVerdict * echoes;
  bytes += config.method == Method::kDonex2d ? Newness2d::bytesFor(extent) : Newness3d::bytesFor(extent);
  bytes += SightHistory::bytesFor(config.evidence.history_length, kHistorySpacing, echoes);
  bytes += Ground::bytesFor(reach, echoes);
  return bytes + CandidateFinder::bytesFor(reach, config.objects, echoes) + kThings * echoes;
}

}  // namespace donex
