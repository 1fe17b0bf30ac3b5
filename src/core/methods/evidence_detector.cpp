#include <algorithm>
#include <cmath>
#include <limits>

#include "core/evidence/ground.h"
#include "core/evidence/loose_echoes.h"
#include "core/evidence/newness.h"
#include "core/evidence/own_body.h"
#include "core/grid/selection.h"
#include "core/grid/simd.h"
#include "core/grid/storage.h"
#include "core/grid/workers.h"
#include "core/methods/detectors.h"
#include "core/methods/evidence_explanation.h"
#include "core/methods/stream_guard.h"
#include "core/objects/low_parts.h"
#include "core/objects/object_tracker.h"
#include "core/objects/parts_beside.h"
#include "core/objects/segmenter.h"
#include "core/objects/trimmer.h"
#include "core/pi.h"
#include "core/sight/second_returns.h"

namespace donex {
namespace {

static_assert(kStretch % EchoBlock::kSize == 0);
constexpr std::size_t kPrefetchAhead = 32;  // echoes; long enough for memory to answer

struct EvidenceDetectorOptions {
  float lowest_of_objects = 0.07F;  ///< from here up to the ground clearance echoes may belong to an object [m]
  double least_ground = 0.05;       ///< of the echoes in the region; with fewer on it the ground is taken for removed
  double most_beneath = 0.25;       ///< as many as lie on it; with more beneath it is none
  float ground_roughness = 0.1F;    ///< echoes so near to the ground's height lie on it [m]
  std::size_t ground_stride = 4;    ///< of the echoes that are asked for it: shares need no more
  double history_spacing = 0.09;    ///< a 10 Hz sensor's every scan, a 20 Hz sensor's every second [s]
};

/// How a turn's echoes in the region lie to the ground that was found.
struct GroundCount {
  std::size_t inside = 0, on = 0, beneath = 0;
};

SightHistory historyOf(const EvidenceConfig& e, const EvidenceDetectorOptions& options) {
  return SightHistory(e.history_length, options.history_spacing, static_cast<float>(e.sight_margin),
                      {e.careful_sight, std::tan(e.sight_gap * kRadiansPerDegree)});
}

/// By height above ground [m], to the echoes that are inside and solid.
DONEX_WIDE_LOOPS void giveRoles(const float* heights, const std::uint8_t* inside, const std::uint8_t* is_solid,
                                std::size_t count, float connects_above, float follows_above, ClusterRole* roles) {
  static_assert(static_cast<int>(ClusterRole::kNone) == 0);
  for (std::size_t i = 0; i < count; ++i) {
    const int takes_part = inside[i] & is_solid[i];
    const int connects = takes_part & static_cast<int>(heights[i] > connects_above);
    const int follows = takes_part & (1 - connects) & static_cast<int>(heights[i] > follows_above);
    roles[i] = static_cast<ClusterRole>(connects * static_cast<int>(ClusterRole::kConnects) +
                                        follows * static_cast<int>(ClusterRole::kFollows));
  }
}

double meanOf(const std::vector<std::uint8_t>& marks) {
  return static_cast<double>(std::count(marks.begin(), marks.end(), 1)) / static_cast<double>(marks.size());
}

/// What both grids share; `PlaceJudge` is what differs between them.
template <class PlaceJudge>
class EvidenceDetector : public Detector {
 public:
  explicit EvidenceDetector(const Config& config)
      : config_(config),
        workers_(config.threads),
        places_(config.scrolling()),  // births are times, which resampling would blur
        clock_(config.evidence.birth_age ? config.evidence.birth_window : 0.0),
        sights_(historyOf(config.evidence, options_)),
        own_body_(config.self),
        ground_(reachOf(config.region)),
        segmenter_(reachOf(config.region), config.objects),
        parts_(config.objects.cell),
        tracker_(config.objects),
        trimmer_(reachOf(config.region), config.objects),
        low_parts_(reachOf(config.region), config.evidence) {}

  void process(const Scan& scan, EchoLabels& labels) override {
    guard_.admit(scan);
    places_.shift(scan.odom_from_base);  // voxel shift (paper, "Ego motion")
    enter(scan);
    const TurnPart part = sights_.arrive(scan, judged_.is_solid, workers_);
    judged_.continues_turn = part == TurnPart::kContinuing;
    judged_.beams_apart = sights_.beamsApart();
    if (!judged_.continues_turn) clock_.begin(scan.stamp);
    workers_.both([&] { estimateGround(part); }, [&] { sights_.draw(scan, judged_.is_solid); });
    heightsAboveGround(part);
    loose_echoes_.loosen(part, scan.stamp, sights_.newest(), judged_.roles);
    judged_.places.assign(judged_.points.size(), Place::kUnobserved);
    if (config_.objects.enabled) parts_.join(part, scan, sights_.turns(), judged_);
    const SightView before = sights_.seenBefore(judged_.odom_from_points);
    workers_.both([&] { judgePlaces(before); }, [&] { learnAndConnect(part, scan); });
    sights_.keep();
    const ScanSight now = sights_.newestSeenFrom(judged_.odom_from_points);
    if (config_.objects.enabled) {
      tracker_.predict(judged_, predictions_);
      segmenter_.segment(judged_, predictions_, segments_, workers_);
      tellPlumes();
      parts_.relate(judged_, segments_);
      tracker_.update(judged_, segments_, predictions_, now, verdicts_, workers_);
      trimmer_.trim(judged_, segments_, verdicts_, proofs_, workers_);
      // Another view: the one from before the sights were kept is no longer valid.
      low_parts_.join(judged_, in_voxels_.inside, sights_.seenBefore(judged_.odom_from_points), ground_, verdicts_,
                      segments_, proofs_);
      tracker_.describe(judged_, segments_);
      loose_echoes_.join(sights_.newest(), judged_.roles, proofs_);
      parts_.settle(sights_.newest(), segments_, verdicts_, judged_);
      proofs_.resize(judged_.points.size());
    } else {
      proveByPlaces();
    }
    write(labels);
  }

  void reset() override {
    places_.reset();
    guard_.reset();
    clock_.reset();
    ground_now_ = ground_before_ = GroundCount();
    sights_.reset();
    own_body_.reset();
    second_returns_.reset();
    loose_echoes_.reset();
    parts_.reset();
    tracker_.reset();
    proofs_.clear();
  }

  const std::vector<Object>& objects() const override { return tracker_.objects(); }

  std::vector<Eigen::Vector3f> dynamicCells() const override {
    return cellCenters(places_.window(), in_voxels_, movingEchoes(proofs_));
  }

  std::vector<EchoReason> reasons() const override { return reasonsOf(judged_, in_voxels_.inside, proofs_); }
  std::vector<Proof> proofs() const override { return proofs_; }

  MemoryCells memoryCells() const override {
    return memoryCellsOf(places_, clock_, config_.evidence, sights_, judged_.odom_from_points);
  }

  std::size_t cloudsPerTurn() const override { return sights_.turns().cloudsPerTurn(); }
  std::optional<MeasuredSensor> measuredSensor() const override {
    std::optional<MeasuredSensor> sensor = sights_.measured();
    if (sensor) sensor->second_returns = second_share_;
    return sensor;
  }
  bool lacksGround() const override { return lacks_ground_; }

  GridOutline outline() const override { return places_.window().outline(); }

  std::size_t memoryBytes() const override {
    const std::size_t in_grid = in_voxels_.echoes.capacity() * sizeof(Eigen::Vector3f) + in_voxels_.inside.capacity();
    const std::size_t judged = judged_.points.capacity() * sizeof(Eigen::Vector3f) +
                               judged_.heights.capacity() * sizeof(float) + judged_.is_echo.capacity() +
                               judged_.is_solid.capacity() + judged_.roles.capacity() + judged_.places.capacity() +
                               judged_.together.capacity() * sizeof(std::uint32_t) + proofs_.capacity();
    const std::size_t decided =
        segments_.memoryBytes() + predictions_.capacity() * sizeof(Prediction) + verdicts_.capacity() * sizeof(Verdict);
    return in_grid + judged + decided + places_.memoryBytes() + sights_.memoryBytes() + own_body_.memoryBytes() +
           second_returns_.memoryBytes() + loose_echoes_.memoryBytes() + ground_.memoryBytes() +
           segmenter_.memoryBytes() + trimmer_.memoryBytes() + low_parts_.memoryBytes() + tracker_.memoryBytes() +
           parts_.memoryBytes();
  }

 private:
  /// Every frame once: in voxels, in metres, and what lies between them and the odometry. The own body and second
  /// returns take part in nothing.
  void enter(const Scan& scan) {
    const GridWindow& window = places_.window();
    window.beginScan(scan, in_voxels_);
    judged_.stamp = scan.stamp;
    judged_.odom_from_points = window.odomFromWindow();
    judged_.sensor = in_voxels_.origin * static_cast<float>(window.voxelSize());
    resizeTo(judged_.points, scan.echoes.size());
    resizeTo(judged_.is_echo, scan.echoes.size());
    resizeTo(judged_.is_solid, scan.echoes.size());
    const std::vector<std::uint8_t>& second =
        scan.second_returns.empty() ? second_returns_.find(scan.echoes) : scan.second_returns;
    second_share_ = second.empty() ? 0.0 : meanOf(second);
    forEachStretch(workers_, scan.echoes.size(), [&](std::size_t first, std::size_t last) {
      window.enterSome(scan, first, last, in_voxels_);
      placeSomePoints(window, in_voxels_, first, last, judged_.points, judged_.is_echo);
      leaveOutSecond(second, first, last);
      std::copy_n(judged_.is_echo.data() + first, last - first, judged_.is_solid.data() + first);
      own_body_.leaveOut(scan, first, last, judged_.is_solid);
    });
  }

  void leaveOutSecond(const std::vector<std::uint8_t>& second, std::size_t first, std::size_t last) {
    if (second.empty()) return;
    for (std::size_t i = first; i < last; ++i) judged_.is_echo[i] &= static_cast<std::uint8_t>(1 - second[i]);
  }

  /// Whether hardly an echo in the region lies on what was found, or many lie beneath it: then somebody has removed the
  /// ground, and the lowest echoes of objects stand in for it. Parts are asked together with the turn before.
  bool isGroundMissing(TurnPart part) {
    if (part != TurnPart::kContinuing) {
      ground_before_ = part == TurnPart::kFirst ? ground_now_ : GroundCount();
      ground_now_ = GroundCount();
    }
    for (std::size_t i = 0; i < judged_.points.size(); i += options_.ground_stride) {
      const bool is_asked = (in_voxels_.inside[i] & judged_.is_solid[i]) != 0;
      if (!is_asked) continue;
      const float height = ground_.heightOfEcho(i, judged_.points[i].z());
      ++ground_now_.inside;
      ground_now_.beneath += height < -options_.ground_roughness ? 1U : 0U;
      ground_now_.on += std::abs(height) <= options_.ground_roughness ? 1U : 0U;
    }
    const auto on = static_cast<double>(ground_now_.on + ground_before_.on);
    return on < options_.least_ground * static_cast<double>(ground_now_.inside + ground_before_.inside) ||
           static_cast<double>(ground_now_.beneath + ground_before_.beneath) > options_.most_beneath * on;
  }

  float clearance() const { return static_cast<float>(config_.evidence.ground_clearance); }

  void estimateGround(TurnPart part) {
    if (!config_.evidence.ground) return;
    ground_.estimate(part, judged_.odom_from_points.translation(), judged_.sensor, judged_.points, judged_.is_solid);
  }

  /// Ground: the height of every echo, and so its role in clusters.
  void heightsAboveGround(TurnPart part) {
    judged_.has_ground = config_.evidence.ground;
    lacks_ground_ = judged_.has_ground && isGroundMissing(part);
    resizeTo(judged_.heights, judged_.points.size());
    resizeTo(judged_.roles, judged_.points.size());
    forEachStretch(workers_, judged_.points.size(), [&](std::size_t first, std::size_t last) {
      setHeights(first, last);
      setRoles(first, last);
    });
  }

  void setHeights(std::size_t first, std::size_t last) {
    if (judged_.has_ground) {
      ground_.heightsOf(judged_.points, first, last, judged_.heights);
      if (!lacks_ground_) return;
      // Nothing is on the ground, nor beneath it.
      for (std::size_t i = first; i < last; ++i) judged_.heights[i] = std::max(judged_.heights[i], 0.0F) + clearance();
    } else {
      // Without the step there is no ground to stand above: heights are the window's.
      for (std::size_t i = first; i < last; ++i) judged_.heights[i] = judged_.points[i].z();
    }
  }

  void setRoles(std::size_t first, std::size_t last) {
    constexpr float kAnyHeight = -std::numeric_limits<float>::infinity();
    const bool knows_ground = judged_.has_ground && !lacks_ground_;
    const float connects_above = knows_ground ? clearance() : kAnyHeight;
    giveRoles(judged_.heights.data() + first, in_voxels_.inside.data() + first, judged_.is_solid.data() + first,
              last - first, connects_above, options_.lowest_of_objects, judged_.roles.data() + first);
  }

  /// What needs the roles but not the places.
  void learnAndConnect(TurnPart part, const Scan& scan) {
    if (config_.objects.enabled) segmenter_.connect(judged_);
    own_body_.learn(part, scan, judged_.is_echo, judged_.heights, clearance());
  }

  /// Free evidence, careful sight, birth age, neighbourhood: asked of the scans before this one.
  void judgePlaces(const SightView& before) {
    const auto connects = [&](std::size_t i) { return judged_.roles[i] == ClusterRole::kConnects; };
    forEachSelection(0, judged_.own(), connects, [&](const std::uint32_t* asked, std::size_t count) {
      for (std::size_t k = 0; k < count; ++k) {
        if (k + kPrefetchAhead < count) places_.expect(in_voxels_.echoes[asked[k + kPrefetchAhead]]);
        const std::uint32_t i = asked[k];
        judged_.places[i] = places_.judge(in_voxels_.echoes[i], judged_.points[i], clock_, before);
      }
    });
  }

  /// Dust and spray that were connected are loose after all.
  void tellPlumes() {
    for (Segment& segment : segments_) {
      if (segment.is_mixed) continue;
      segment.is_of_plume =
          loose_echoes_.loosenPlume(sights_.newest(), segment.echoes.data(), segment.echoes.size(), judged_.roles);
    }
  }

  /// Without objects every echo is judged by its place alone.
  void proveByPlaces() {
    proofs_.assign(judged_.points.size(), Proof::kNone);
    if (clock_.scan() == 1) return;  // nothing is known yet
    for (std::size_t i = 0; i < judged_.points.size(); ++i) {
      const bool is_new = in_voxels_.inside[i] != 0 && isNewPlace(judged_.places[i]);
      if (is_new) proofs_[i] = Proof::kAlone;
    }
  }

  void write(EchoLabels& labels) const {
    labels.assign(judged_.points.size());
    forEachStretch(workers_, judged_.points.size(), [&](std::size_t first, std::size_t last) {
      // Bytes may be anything: as members, these would be read again after each label that is written.
      const Proof* proofs = proofs_.data();
      const ClusterRole* roles = judged_.roles.data();
      const Place* places = judged_.places.data();
      const std::uint8_t* inside = in_voxels_.inside.data();
      std::uint8_t* dynamic = labels.dynamic.data();
      std::uint8_t* observed = labels.observed.data();
      const std::uint8_t knows = clock_.scan() == 1 ? 0 : 1;  // nothing in the first scan
      for (std::size_t i = first; i < last; ++i) {
        const auto is_moving = static_cast<std::uint8_t>(proofs[i] != Proof::kNone);
        const auto is_ground = static_cast<std::uint8_t>(roles[i] != ClusterRole::kConnects);
        const auto is_seen = static_cast<std::uint8_t>(places[i] != Place::kUnobserved);
        const auto is_known = static_cast<std::uint8_t>(inside[i] & (is_ground | is_seen) & knows);
        dynamic[i] = is_moving;
        observed[i] = static_cast<std::uint8_t>(is_moving | is_known);
      }
    });
  }

  Config config_;
  EvidenceDetectorOptions options_;
  Workers workers_;
  StreamGuard guard_;
  PlaceJudge places_;
  ScanClock clock_;
  SightHistory sights_;
  OwnBody own_body_;
  SecondReturns second_returns_;
  LooseEchoes loose_echoes_;
  Ground ground_;
  Segmenter segmenter_;
  PartsBeside parts_;
  ObjectTracker tracker_;
  Trimmer trimmer_;
  LowParts low_parts_;

  // Of the present scan; storage is kept from scan to scan.
  GridScan in_voxels_;
  JudgedScan judged_;
  Predictions predictions_;
  Segments segments_;
  Verdicts verdicts_;
  std::vector<Proof> proofs_;               ///< per echo
  GroundCount ground_now_, ground_before_;  ///< of this turn, and of the turn before
  double second_share_ = 0.0;
  bool lacks_ground_ = false;
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
  constexpr double kJudged = sizeof(Eigen::Vector3f) + sizeof(float) + 2.0;
  constexpr double kDecided = sizeof(ClusterRole) + sizeof(Place) + sizeof(Proof);
  constexpr double kObjects = 20.0;  // bytes per echo, about: segments, tracks and their traces
  const double reach = reachOf(config.region);
  const Eigen::Vector3d extent = GridWindow::extentOf(config.scrolling());
  double bytes = roomFor((kInGrid + kJudged) * echoes) + kDecided * echoes;
  bytes += config.method == Method::kDonex2d ? Newness2d::bytesFor(extent) : Newness3d::bytesFor(extent);
  bytes += SightHistory::bytesFor(config.evidence.history_length, EvidenceDetectorOptions().history_spacing, echoes);
  bytes += OwnBody::bytesFor(config.self) + LooseEchoes::bytesFor(echoes);
  bytes += Ground::bytesFor(reach, echoes);
  bytes += Segmenter::bytesFor(reach, config.objects, echoes) + Trimmer::bytesFor(reach, config.objects, echoes);
  bytes += LowParts::bytesFor(reach, echoes);
  return bytes + kObjects * echoes;
}

}  // namespace donex
