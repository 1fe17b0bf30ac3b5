// The whole detector on simulated drives: how well it labels, and what holds for every label.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

#include <gtest/gtest.h>

#include "core/methods/labelled_drives.h"
#include "support/oracle.h"

namespace donex {
namespace {

using testing::configOf;
using testing::dynamicEchoes;
using testing::expectSame;
using testing::labelsOf;
using testing::Score;
using testing::simulatedDrive;
using testing::street;
using testing::TrueScan;

/// A few points below what was measured.
struct Floor {
  const char* scene;
  double iou_3d, iou_2d, precision;
};

std::ostream& operator<<(std::ostream& out, const Floor& floor) { return out << floor.scene; }

class Labels : public ::testing::TestWithParam<Floor> {
 protected:
  static Score scoreOf(Method method, const std::vector<TrueScan>& drive) {
    constexpr std::size_t kWarmUp = 5;
    const std::vector<EchoLabels> labels = labelsOf(configOf(method), drive);
    EXPECT_EQ(dynamicEchoes(labels[0]), 0U) << "nothing is known in the first scan";
    Score score;
    for (std::size_t k = 0; k < drive.size(); ++k) {
      EXPECT_EQ(labels[k].dynamic.size(), drive[k].scan.echoes.size());
      EXPECT_EQ(labels[k].observed.size(), drive[k].scan.echoes.size());
      if (k >= kWarmUp) score.add(drive[k], labels[k]);
      std::size_t without_evidence = 0;
      for (std::size_t i = 0; i < labels[k].dynamic.size(); ++i) {
        without_evidence += labels[k].dynamic[i] > labels[k].observed[i] ? 1U : 0U;
      }
      EXPECT_EQ(without_evidence, 0U);
    }
    std::cout << GetParam() << ": moving IoU " << score.iou() << ", precision " << score.precision() << ", recall "
              << score.recall() << '\n';
    return score;
  }
};

TEST_P(Labels, AreNearTheTruth) {
  const std::vector<TrueScan> drive = simulatedDrive(GetParam().scene, 64, 25);
  const Score in_3d = scoreOf(Method::kDonex3d, drive);
  EXPECT_GE(in_3d.iou(), GetParam().iou_3d);
  EXPECT_GE(in_3d.precision(), GetParam().precision);
  const Score in_2d = scoreOf(Method::kDonex2d, drive);
  EXPECT_GE(in_2d.iou(), GetParam().iou_2d);
  EXPECT_GE(in_2d.precision(), GetParam().precision);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Labels,
                         ::testing::Values(Floor{"intersection", 0.88, 0.89, 0.97}, Floor{"street", 0.94, 0.94, 0.97},
                                           Floor{"lead_vehicle", 0.9, 0.9, 0.96}));

class BothGrids : public ::testing::TestWithParam<Method> {
 protected:
  Config config() const { return configOf(GetParam()); }
};

TEST_P(BothGrids, NothingMovesInAnEmptyRoom) {
  static const std::vector<TrueScan> drive = simulatedDrive("empty_room", 0, 30);
  std::size_t observed = 0;
  for (const EchoLabels& labels : labelsOf(config(), drive)) {
    EXPECT_EQ(dynamicEchoes(labels), 0U);
    observed = static_cast<std::size_t>(std::count(labels.observed.begin(), labels.observed.end(), 1));
  }
  EXPECT_GT(observed, drive[0].scan.echoes.size() / 2) << "and that is known by now";
}

TEST_P(BothGrids, SameScansSameLabels) { expectSame(labelsOf(config(), street()), labelsOf(config(), street())); }

TEST_P(BothGrids, ResetIsAFreshDetector) {
  const auto detector = makeDetector(config());
  labelsOf(*detector, simulatedDrive("intersection", 16, 6, 4));
  detector->reset();
  EXPECT_TRUE(detector->objects().empty());
  EXPECT_TRUE(detector->dynamicCells().empty());
  expectSame(labelsOf(*detector, street()), labelsOf(config(), street()));
}

TEST_P(BothGrids, CompensationIsThePapersAlone) {
  Config resampling = config();
  resampling.compensation = Compensation::kResample;
  expectSame(labelsOf(resampling, street()), labelsOf(config(), street()));
}

TEST_P(BothGrids, WhatIsNoEchoOrOutsideIsNeverDynamicAndChangesNoOther) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const std::vector<Eigen::Vector3f> none{{kNan, 1.0F, 1.0F}, {kInfinity, 0.0F, 0.0F}, {2.0F, -kInfinity, 1.0F},
                                          {1e6F, 0.0F, 0.0F}, {0.0F, 3e30F, 0.0F},     {1.0F, 2.0F, kNan}};
  std::vector<TrueScan> disturbed = street();
  for (TrueScan& next : disturbed) next.scan.echoes.insert(next.scan.echoes.end(), none.begin(), none.end());
  const auto expected = labelsOf(config(), street());
  auto labels = labelsOf(config(), disturbed);
  for (EchoLabels& of_scan : labels) {
    for (std::size_t i = of_scan.dynamic.size() - none.size(); i < of_scan.dynamic.size(); ++i) {
      EXPECT_EQ(of_scan.dynamic[i], 0) << none[i - (of_scan.dynamic.size() - none.size())].transpose();
      EXPECT_EQ(of_scan.observed[i], 0);
    }
    of_scan.dynamic.resize(of_scan.dynamic.size() - none.size());
    of_scan.observed.resize(of_scan.observed.size() - none.size());
  }
  expectSame(labels, expected);
}

TEST_P(BothGrids, EchoesOutsideTheRegionAreNeverDynamic) {
  Config config = this->config();
  config.region = {-10.0, 15.0, -8.0, 8.0, -1.0, 3.0};
  const auto labels = labelsOf(config, street());
  std::size_t outside = 0;
  for (std::size_t k = 0; k < labels.size(); ++k) {
    const Scan& scan = street()[k].scan;
    for (std::size_t i = 0; i < scan.echoes.size(); ++i) {
      const Eigen::Vector3d p = scan.base_from_sensor * scan.echoes[i].cast<double>();
      const bool is_out = p.x() < -10.01 || p.x() > 15.01 || std::abs(p.y()) > 8.01 || p.z() < -1.01 || p.z() > 3.01;
      if (!is_out) continue;
      ++outside;
      ASSERT_EQ(labels[k].dynamic[i], 0) << p.transpose();
    }
  }
  EXPECT_GT(outside, 1000U);
}

TEST_P(BothGrids, TheOwnBodyDoesNotMove) {
  constexpr std::size_t kWarmUp = 6;  // until the own body is known
  simulation::DisturbanceOptions disturbance;
  disturbance.own_body = true;
  const std::vector<TrueScan> drive = simulatedDrive("street", 32, 14, 1, disturbance);
  const auto countMoving = [&](const Config& config) {
    std::size_t moving = 0;
    const auto labels = labelsOf(config, drive);
    for (std::size_t k = kWarmUp; k < drive.size(); ++k) {
      for (std::size_t i = 0; i < drive[k].truth.size(); ++i) {
        const bool is_matter = drive[k].truth[i] == simulation::Disturbance::kDisturbed;
        moving += is_matter && labels[k].dynamic[i] != 0 ? 1U : 0U;
      }
    }
    return moving;
  };
  Config off = config();
  off.self.detection = false;
  const std::size_t before = countMoving(off);
  EXPECT_GT(before, 50U) << "nothing to do";
  EXPECT_LT(countMoving(config()), before / 5);
}

TEST_P(BothGrids, EmptyScansAreScans) {
  const auto detector = makeDetector(config());
  EchoLabels labels;
  Scan nothing;
  for (int k = 0; k < 5; ++k) {
    nothing.stamp = 0.1 * k;
    detector->process(nothing, labels);
    EXPECT_TRUE(labels.dynamic.empty());
  }
}

TEST_P(BothGrids, EveryStepCanBeSwitchedOffAlone) {
  const auto differ = [](const std::vector<EchoLabels>& a, const std::vector<EchoLabels>& b) {
    bool one_differs = false;
    for (std::size_t k = 0; k < a.size(); ++k) one_differs |= a[k].dynamic != b[k].dynamic;
    return one_differs;
  };
  // Without objects, which mend what the other steps leave.
  Config echo_by_echo = config();
  echo_by_echo.objects.enabled = false;
  const auto with_all = labelsOf(echo_by_echo, street());
  const auto matters = [&](bool EvidenceConfig::*step) {
    Config config = echo_by_echo;
    config.evidence.*step = false;
    return differ(labelsOf(config, street()), with_all);
  };
  EXPECT_TRUE(matters(&EvidenceConfig::free_evidence));
  EXPECT_TRUE(matters(&EvidenceConfig::careful_sight));
  EXPECT_TRUE(matters(&EvidenceConfig::birth_age));
  EXPECT_TRUE(matters(&EvidenceConfig::neighbourhood));
  EXPECT_TRUE(matters(&EvidenceConfig::ground));
  const auto with_objects = labelsOf(config(), street());
  EXPECT_TRUE(differ(with_objects, with_all)) << "objects";
  Config without_motion = config();
  without_motion.objects.motion = false;
  EXPECT_TRUE(differ(labelsOf(without_motion, street()), with_objects)) << "object_motion";
}

TEST_P(BothGrids, ObjectsHoldTheDynamicEchoes) {
  const auto detector = makeDetector(config());
  EchoLabels labels;
  std::size_t moving_objects = 0;
  for (const TrueScan& next : street()) {
    detector->process(next.scan, labels);
    std::size_t in_objects = 0;
    for (const Object& object : detector->objects()) {
      if (!object.dynamic) continue;
      ++moving_objects;
      in_objects += object.echoes;
      EXPECT_TRUE(object.velocity.allFinite() && object.size.allFinite());
      EXPECT_TRUE(object.odom_from_box.matrix().allFinite());
    }
    EXPECT_GE(in_objects, dynamicEchoes(labels));  // more where a neighbour was released
    EXPECT_EQ(detector->dynamicCells().empty(), dynamicEchoes(labels) == 0);
  }
  EXPECT_GT(moving_objects, 5U);
}

INSTANTIATE_TEST_SUITE_P(Grids, BothGrids, ::testing::Values(Method::kDonex3d, Method::kDonex2d));

TEST(WithoutEvidence, ADriveIsLabelledAsThePaperSays) {
  const std::vector<TrueScan> drive = simulatedDrive("street", 16, 6, 8);
  for (const Method method : {Method::kDonex3d, Method::kDonex2d}) {
    Config config = paperConfig(method);
    config.voxel_size = 0.5;
    config.region = {-15.0, 15.0, -15.0, 15.0, -3.0, 4.0};
    const auto labels = labelsOf(config, drive);
    oracle::Donex3d oracle_3d(config);
    oracle::Donex2d oracle_2d(config);
    std::size_t dynamic = 0;
    for (std::size_t k = 0; k < drive.size(); ++k) {
      const bool is_3d = method == Method::kDonex3d;
      EXPECT_EQ(labels[k].dynamic, is_3d ? oracle_3d.process(drive[k].scan) : oracle_2d.process(drive[k].scan));
      dynamic += dynamicEchoes(labels[k]);
    }
    EXPECT_GT(dynamic, 50U);
  }
}

}  // namespace
}  // namespace donex
