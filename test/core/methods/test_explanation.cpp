// The reasons agree with the labels, and the cells shown are those of the memory.
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "donex/detector.h"
#include "support/simulated_drive.h"

namespace donex {
namespace {

using testing::TrueScan;

Scan scanOf(double stamp, std::vector<Eigen::Vector3f> echoes) {
  Scan scan;
  scan.stamp = stamp;
  scan.echoes = std::move(echoes);
  return scan;
}

bool holds(const std::vector<Eigen::Vector3f>& centers, const Eigen::Vector3f& point, float voxel_size) {
  for (const Eigen::Vector3f& center : centers) {
    if (((center - point).array().abs() <= 0.5F * voxel_size + 1e-4F).all()) return true;
  }
  return false;
}

TEST(Explanation, ThePapersCells) {
  Config config = paperConfig(Method::kDonex3d);
  const auto detector = makeDetector(config);
  const Eigen::Vector3f ahead(5.1F, 0.1F, 0.1F), aside(0.1F, 5.1F, 0.1F), behind(10.1F, 0.2F, 0.2F);
  EchoLabels labels;
  detector->process(scanOf(1.0, {ahead, aside}), labels);
  EXPECT_TRUE(detector->memoryCells().shadowed.empty()) << "nobody watches";
  detector->watch(true);
  detector->process(scanOf(1.1, {behind}), labels);
  const MemoryCells cells = detector->memoryCells();
  ASSERT_EQ(cells.seen_through.size(), 1U);
  ASSERT_EQ(cells.shadowed.size(), 1U);
  const auto size = static_cast<float>(config.voxel_size);
  EXPECT_TRUE(holds(cells.seen_through, ahead, size));
  EXPECT_TRUE(holds(cells.shadowed, aside, size));
  EXPECT_EQ(detector->reasons(), std::vector<EchoReason>{EchoReason::kMoving});
  detector->process(scanOf(1.2, {behind, {70.0F, 0.0F, 0.0F}, {NAN, 0.0F, 0.0F}}), labels);
  EXPECT_EQ(detector->reasons(),
            (std::vector<EchoReason>{EchoReason::kSettled, EchoReason::kOutside, EchoReason::kNoEcho}));
}

/// What a reason says about the labels; the first scan knows nothing.
void expectAgreement(EchoReason reason, bool dynamic, bool observed, const std::string& where) {
  EXPECT_EQ(dynamic, reason == EchoReason::kMoving) << where << describe(reason);
  const bool is_known = reason == EchoReason::kGround || reason == EchoReason::kSettled ||
                        reason == EchoReason::kNewAlone || reason == EchoReason::kMoving;
  EXPECT_EQ(observed, is_known) << where << describe(reason);
}

TEST(Explanation, ReasonsAgreeWithTheLabels) {
  const auto drive = testing::simulatedDrive("street", 32, 12, 3);
  for (const Method method : {Method::kDonex3d, Method::kDonex2d}) {
    Config config;
    config.method = method;
    const auto detector = makeDetector(config);
    std::set<EchoReason> seen;
    std::set<Proof> proven;
    for (const TrueScan& scan : drive) {
      EchoLabels labels;
      detector->process(scan.scan, labels);
      const auto reasons = detector->reasons();
      const auto proofs = detector->proofs();
      ASSERT_EQ(reasons.size(), scan.scan.echoes.size());
      ASSERT_EQ(proofs.size(), scan.scan.echoes.size());
      if (&scan == &drive.front()) continue;
      for (std::size_t i = 0; i < reasons.size(); ++i) {
        expectAgreement(reasons[i], labels.dynamic[i] != 0, labels.observed[i] != 0,
                        "echo " + std::to_string(i) + ": ");
        EXPECT_EQ(proofs[i] != Proof::kNone, labels.dynamic[i] != 0) << "echo " << i << ": " << nameOf(proofs[i]);
        seen.insert(reasons[i]);
        proven.insert(proofs[i]);
      }
    }
    EXPECT_GE(seen.size(), 5U) << "ground, unobserved, settled, outside and moving at least";
    EXPECT_EQ(proven.count(Proof::kEnteredFree), 1U);
    EXPECT_EQ(proven.count(Proof::kAlone), 0U) << "objects are formed";
  }
}

/// A wall all around, `range` [m] away.
Scan wallAt(double range, double stamp) {
  std::vector<Eigen::Vector3f> echoes;
  for (int azimuth = 0; azimuth < 720; ++azimuth) {
    for (int beam = 0; beam < 5; ++beam) {
      const double angle = azimuth * M_PI / 360.0, slope = 0.02 * beam + 0.01;
      const Eigen::Vector3d direction = Eigen::Vector3d(std::cos(angle), std::sin(angle), slope).normalized();
      echoes.push_back((range * direction).cast<float>());
    }
  }
  return scanOf(stamp, std::move(echoes));
}

TEST(Explanation, TheFlickerOfASurfaceWasSeenFreeAndIsSettled) {
  for (const Method method : {Method::kDonex3d, Method::kDonex2d}) {
    Config config;
    config.method = method;
    config.evidence.ground = false;
    config.evidence.sight_margin = 0.02;  // so that the place before the wall is seen free at all
    const auto detector = makeDetector(config);
    EchoLabels labels;
    for (int k = 0; k < 10; ++k) detector->process(wallAt(10.05, 0.1 * k), labels);
    for (int k = 10; k < 13; ++k) {
      detector->process(wallAt(9.95, 0.1 * k), labels);  // across the border of voxels at 10 m
      EXPECT_EQ(labels.dynamic[0], 0);
      EXPECT_EQ(labels.observed[0], 1);
      EXPECT_EQ(detector->reasons()[0], EchoReason::kSettled);
    }
  }
}

TEST(Explanation, CellsWithEvidenceAreThoseThatAreNotHit) {
  const auto drive = testing::simulatedDrive("intersection", 32, 10, 3);
  const Config config;
  const auto detector = makeDetector(config);
  EchoLabels labels;
  for (const TrueScan& scan : drive) detector->process(scan.scan, labels);
  const MemoryCells cells = detector->memoryCells();
  EXPECT_GT(cells.shadowed.size(), 100U);
  EXPECT_GT(cells.seen_through.size(), 10U) << "behind what moved";
  // Some of the shown cells: they hold no echo of the last scan, but those of the ground, which are never remembered.
  const auto size = static_cast<float>(config.voxel_size);
  const Scan& last = drive.back().scan;
  for (const auto* kind : {&cells.shadowed, &cells.seen_through}) {
    std::size_t above_ground = 0;
    for (std::size_t i = 0; i < kind->size(); i += 5) {
      if ((*kind)[i].z() < 1.0F) continue;
      ++above_ground;
      for (const Eigen::Vector3f& echo : last.echoes) {
        const Eigen::Vector3f in_odom = (last.odomFromSensor() * echo.cast<double>()).cast<float>();
        const bool is_hit = ((in_odom - (*kind)[i]).array().abs() < 0.5F * size - 1e-3F).all();
        ASSERT_FALSE(is_hit) << (*kind)[i].transpose();
      }
    }
    EXPECT_GT(above_ground, 2U);
  }
}

}  // namespace
}  // namespace donex
