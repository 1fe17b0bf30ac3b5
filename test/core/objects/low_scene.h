// Echoes over a ground with proofs of motion, and what earlier scans saw in their directions.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <numeric>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/objects/low_parts.h"

namespace donex::testing {

inline constexpr double kReach = 14.0;
inline constexpr double kMount = 1.8;  // [m] above the ground
inline const Eigen::Vector3d kSensor(0.0, 0.0, kMount);

using Surface = std::function<double(double, double)>;
inline double level(double, double) { return 0.0; }

/// Points frame is the odometry frame.
class LowScene {
 public:
  explicit LowScene(Surface surface = level) : surface_(std::move(surface)) { judged.sensor = kSensor.cast<float>(); }

  /// At `height` [m] above the ground; the number of the echo.
  std::size_t add(double x, double y, double height, Proof proof = Proof::kNone) {
    judged.points.push_back(Eigen::Vector3d(x, y, surface_(x, y) + height).cast<float>());
    judged.is_solid.push_back(1);
    inside.push_back(1);
    proofs.push_back(proof);
    return proofs.size() - 1;
  }

  /// An earlier scan that saw the bare ground in the directions of all echoes.
  void sawBareGround() {
    std::vector<Eigen::Vector3f> seen;
    for (const Eigen::Vector3f& point : judged.points) {
      const Eigen::Vector3d ray = point.cast<double>() - kSensor;
      double share = 0.5;
      Eigen::Vector3d at = kSensor + share * ray;
      while (share < 3.0 && at.z() > surface_(at.x(), at.y())) at = kSensor + (share += 1e-4) * ray;
      seen.push_back(at.cast<float>());
    }
    saw(seen, kSensor);
  }
  /// An earlier scan that saw something in the echo's direction, so far behind it [m].
  void sawBehind(std::size_t echo, float behind) {
    const Eigen::Vector3f ray = (judged.points[echo] - judged.sensor).normalized();
    saw({judged.points[echo] + behind * ray}, kSensor);
  }
  void saw(const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3d& sensor) {
    Scan scan;
    scan.stamp = stamp_ += 0.1;
    scan.odom_from_base.translation() = sensor;
    for (const Eigen::Vector3f& point : points) scan.echoes.push_back(point - sensor.cast<float>());
    const std::vector<std::uint8_t> is_echo(points.size(), 1);
    history_.arrive(scan, is_echo);
    history_.add(scan, is_echo);
  }
  SightView before() const { return history_.seenFrom(judged.odom_from_points); }

  /// Bare ground is seen all around, but nearer than `hidden` [m] to what moves.
  void findGround(float hidden = 0.0F) {
    std::vector<Eigen::Vector3f> echoes;
    for (double x = -kReach; x <= kReach; x += 0.4) {
      for (double y = -kReach; y <= kReach; y += 0.4) {
        const Eigen::Vector3f echo = Eigen::Vector3d(x, y, surface_(x, y)).cast<float>();
        if (!isNearWhatMoves(echo, hidden)) echoes.push_back(echo);
      }
    }
    echoes.insert(echoes.end(), judged.points.begin(), judged.points.end());
    std::vector<std::uint8_t> is_echo(echoes.size());
    std::transform(echoes.begin(), echoes.end(), is_echo.begin(),
                   [](const Eigen::Vector3f& echo) { return echo.allFinite() ? 1 : 0; });
    ground.estimate(judged.sensor, echoes, is_echo);
    judged.heights.clear();
    judged.roles.clear();
    for (const Eigen::Vector3f& point : judged.points) {
      judged.heights.push_back(ground.heightOf(point));
      judged.roles.push_back(judged.heights.back() > 0.25F ? ClusterRole::kConnects : ClusterRole::kNone);
    }
  }

  /// Proofs after the step, over the bare ground where none was found yet. What moves by one proof is one segment; its
  /// low parts are added to its echoes.
  std::vector<Proof> joinedBy(LowParts& parts) {
    if (judged.heights.size() != judged.points.size()) findGround();
    std::vector<Proof> joined = proofs;
    makeSegments();
    const std::size_t known = echoesOfSegments();
    parts.join(judged, inside, before(), ground, verdicts_, segments_, joined);
    const auto moves = [](Proof proof) { return proof != Proof::kNone; };
    const auto added =
        std::count_if(joined.begin(), joined.end(), moves) - std::count_if(proofs.begin(), proofs.end(), moves);
    EXPECT_EQ(echoesOfSegments(), known + static_cast<std::size_t>(added));
    for (std::size_t i = 0; i < segments_.size(); ++i) {
      for (const std::uint32_t echo : segments_[i].echoes) {
        EXPECT_EQ(joined[echo], isTrimmed(echo) ? Proof::kNone : verdicts_[i].proof);
      }
    }
    return joined;
  }
  std::vector<Proof> joined() {
    LowParts parts(kReach, EvidenceConfig{});
    return joinedBy(parts);
  }
  bool moves(std::size_t echo) { return joined()[echo] != Proof::kNone; }

  JudgedScan judged;
  std::vector<std::uint8_t> inside;
  std::vector<Proof> proofs;
  Ground ground{kReach};

 private:
  void makeSegments() {
    segments_.clear();
    verdicts_.clear();
    for (std::size_t proof = 1; proof < kProofs; ++proof) {
      Segment& segment = segments_.add(0);
      for (std::uint32_t i = 0; i < proofs.size(); ++i) {
        if (proofs[i] == static_cast<Proof>(proof) || isTrimmed(i)) segment.echoes.push_back(i);
      }
      verdicts_.push_back({static_cast<Proof>(proof)});
    }
  }
  /// Some of what stands was one cluster with what moves, and has been taken off.
  bool isTrimmed(std::uint32_t echo) const {
    return echo % 3 == 0 && proofs[echo] == Proof::kNone && judged.roles[echo] == ClusterRole::kConnects;
  }
  std::size_t echoesOfSegments() const {
    return std::accumulate(segments_.begin(), segments_.end(), std::size_t{0},
                           [](std::size_t sum, const Segment& segment) { return sum + segment.echoes.size(); });
  }
  bool isNearWhatMoves(const Eigen::Vector3f& echo, float distance) const {
    for (std::size_t i = 0; i < proofs.size(); ++i) {
      if (proofs[i] != Proof::kNone && (judged.points[i] - echo).head<2>().norm() < distance) return true;
    }
    return false;
  }

  Surface surface_;
  Segments segments_;
  Verdicts verdicts_;
  SightHistory history_{2.0, 0.0, 0.5F, {true, 0.038}};
  double stamp_ = 0.0;
};

}  // namespace donex::testing
