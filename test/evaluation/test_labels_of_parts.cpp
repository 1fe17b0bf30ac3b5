// Scans that come in parts are labelled as whole scans are, and what a border cuts stays one object.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <set>

#include <gtest/gtest.h>

#include "core/objects/parts_beside.h"
#include "donex/memory_bound.h"
#include "evaluation/scan_parts.h"
#include "support/counted_allocations.h"
#include "support/simulated_drive.h"

namespace donex {
namespace {

using testing::Score;
using testing::simulatedDrive;
using testing::TrueScan;

constexpr double kPeriod = 0.1;       // [s]
constexpr std::size_t kWarmUp = 5;    // scans
constexpr std::size_t kSettled = 15;  // scans; by then everything that moves has been seen to

Config configOf(Method method) {
  Config config;
  config.method = method;
  return config;
}

double iouOf(Method method, const std::vector<TrueScan>& drive, std::size_t count) {
  const auto detector = makeDetector(configOf(method));
  ScanParts parts(count);
  Score score;
  for (std::size_t k = 0; k < drive.size(); ++k) {
    parts.cut(drive[k].scan, kPeriod);
    EchoLabels whole, labels;
    whole.assign(drive[k].scan.echoes.size());
    for (std::size_t part = 0; part < count; ++part) {
      detector->process(parts[part], labels);
      parts.putBack(part, labels, whole);
    }
    if (k >= kWarmUp) score.add(drive[k], whole);
  }
  return score.iou();
}

/// Each scan cut by elevation into clouds of as many echoes, one 20 ms after the other.
double iouOfBands(Method method, const std::vector<TrueScan>& drive, std::size_t count) {
  const auto detector = makeDetector(configOf(method));
  Score score;
  EchoLabels labels;
  for (std::size_t k = 0; k < drive.size(); ++k) {
    const std::vector<Eigen::Vector3f>& echoes = drive[k].scan.echoes;
    std::vector<float> slopes;
    for (const Eigen::Vector3f& echo : echoes) slopes.push_back(echo.z() / echo.head<2>().norm());
    std::vector<float> sorted = slopes;
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t band = 0; band < count; ++band) {
      const float first = sorted[band * sorted.size() / count];
      const float end = band + 1 < count ? sorted[(band + 1) * sorted.size() / count] : HUGE_VALF;
      TrueScan part = drive[k];
      part.scan.stamp += 0.02 * static_cast<double>(band);
      part.scan.echoes.clear();
      part.truth.clear();
      for (std::size_t i = 0; i < echoes.size(); ++i) {
        if (slopes[i] < first || slopes[i] >= end) continue;
        part.scan.echoes.push_back(echoes[i]);
        part.truth.push_back(drive[k].truth[i]);
      }
      detector->process(part.scan, labels);
      if (k >= kWarmUp) score.add(part, labels);
    }
  }
  return score.iou();
}

class LabelsOfParts : public ::testing::TestWithParam<Method> {};

/// On the motorway lorries fill several parts.
TEST_P(LabelsOfParts, AreThoseOfWholeScansWithLorriesInThem) {
  const std::vector<TrueScan> drive = simulatedDrive("motorway", 64, 25);
  const double whole = iouOf(GetParam(), drive, 1), in_parts = iouOf(GetParam(), drive, 10);
  std::cout << "whole: moving IoU " << whole << ", in ten parts: " << in_parts << '\n';
  EXPECT_GT(in_parts, whole - 0.01);
}

TEST_P(LabelsOfParts, AreThoseOfWholeScansNearly) {
  const std::vector<TrueScan> drive = simulatedDrive("street", 64, 25);
  const double whole = iouOf(GetParam(), drive, 1);
  std::cout << "whole: moving IoU " << whole << '\n';
  for (const std::size_t count : {4U, 40U}) {
    const double in_parts = iouOf(GetParam(), drive, count);
    std::cout << count << " parts: moving IoU " << in_parts << '\n';
    EXPECT_GT(in_parts, whole - 0.02) << count << " parts";
  }
}

TEST_P(LabelsOfParts, MayBeCutByElevation) {
  const std::vector<TrueScan> drive = simulatedDrive("street", 64, 25);
  const double whole = iouOf(GetParam(), drive, 1);
  for (const std::size_t count : {2U, 3U, 4U}) {
    const double in_bands = iouOfBands(GetParam(), drive, count);
    std::cout << "whole: moving IoU " << whole << ", " << count << " bands: " << in_bands << '\n';
    EXPECT_GT(in_bands, whole - 0.01) << count << " bands";
  }
}

/// The vehicle ahead, which the border between the last part of a turn and the first one cuts in two.
const Object* vehicleAhead(const Detector& detector, const Scan& scan) {
  const Object* ahead = nullptr;
  for (const Object& object : detector.objects()) {
    const Eigen::Vector3d from_vehicle = scan.odom_from_base.inverse() * object.odom_from_box.translation();
    const bool is_ahead = from_vehicle.x() > 3.0 && from_vehicle.x() < 40.0 && std::abs(from_vehicle.y()) < 1.2;
    const bool is_largest = ahead == nullptr || object.echoes > ahead->echoes;
    if (is_ahead && object.dynamic && is_largest) ahead = &object;
  }
  return ahead;
}

TEST_P(LabelsOfParts, AVehicleThatABorderCutsKeepsOneNumberAndOneBox) {
  const std::vector<TrueScan> drive = simulatedDrive("lead_vehicle", 64, 35);
  for (const std::size_t count : {10U}) {
    const auto detector = makeDetector(configOf(GetParam()));
    ScanParts parts(count);
    std::uint32_t id = 0;
    int seen = 0;
    EchoLabels labels;
    for (std::size_t k = 0; k < drive.size(); ++k) {
      parts.cut(drive[k].scan, kPeriod);
      for (std::size_t part = 0; part < count; ++part) {
        detector->process(parts[part], labels);
        const bool is_cut_there = part == 0 || part + 1 == count;
        const Object* object = k < kSettled || !is_cut_there ? nullptr : vehicleAhead(*detector, parts[part]);
        if (object == nullptr) continue;
        id = seen++ == 0 ? object->id : id;
        EXPECT_EQ(object->id, id) << "scan " << k << ", part " << part << " of " << count;
        EXPECT_GT(object->size.y(), 1.4) << "both halves are in the box: scan " << k << ", part " << part;
      }
    }
    EXPECT_GE(seen, 2 * static_cast<int>(drive.size() - kSettled) - 4) << count << " parts";
  }
}

/// A part of a scan, without its echoes on the ground where that is asked for.
Scan partOf(const TrueScan& scan, const ScanParts& parts, std::size_t part, bool has_ground) {
  constexpr std::uint32_t kClass = 0xFFFF;
  const std::set<std::uint32_t> ground{40, 44, 48, 49, 72};  // SemanticKITTI: road to terrain
  Scan cloud = parts[part];
  cloud.echoes.clear();
  for (const std::uint32_t echo : parts.echoesOf(part)) {
    const bool stays = has_ground || ground.count(scan.truth[echo] & kClass) == 0;
    if (stays) cloud.echoes.push_back(scan.scan.echoes[echo]);
  }
  return cloud;
}

/// The side of a lorry hides it in one part; a filter upstream removes it in all.
TEST_P(LabelsOfParts, APartWithoutGroundIsNoRemovedGround) {
  constexpr std::size_t kCount = 10, kHidden = 3, kFirst = 3;
  const std::vector<TrueScan> drive = simulatedDrive("street", 64, 8);
  for (const bool is_filtered : {false, true}) {
    const auto detector = makeDetector(configOf(GetParam()));
    ScanParts parts(kCount);
    EchoLabels labels;
    for (std::size_t k = 0; k < drive.size(); ++k) {
      parts.cut(drive[k].scan, kPeriod);
      for (std::size_t part = 0; part < kCount; ++part) {
        detector->process(partOf(drive[k], parts, part, !is_filtered && part != kHidden), labels);
        if (k < kFirst) continue;
        EXPECT_EQ(detector->lacksGround(), is_filtered) << "scan " << k << ", part " << part;
      }
    }
  }
}

TEST_P(LabelsOfParts, HardlyAllocateAndTakeNoMoreThanWasSaid) {
  const std::vector<TrueScan> drive = simulatedDrive("intersection", 64, 26);
  const std::size_t count = 10;
  ScanParts parts(count);
  std::vector<Scan> clouds;
  std::size_t most = 0;
  for (const TrueScan& scan : drive) {
    most = std::max(most, scan.scan.echoes.size());
    parts.cut(scan.scan, kPeriod);
    for (std::size_t part = 0; part < count; ++part) clouds.push_back(parts[part]);
  }
  EchoLabels labels;
  labels.resize(most);
  const std::size_t bytes_before = testing::liveBytes();
  const auto detector = makeDetector(configOf(GetParam()));
  for (const Scan& cloud : clouds) detector->process(cloud, labels);
  const auto taken = static_cast<double>(testing::liveBytes() - bytes_before);
  EXPECT_LT(taken, 1.1 * memoryBound(configOf(GetParam()), most) + PartsBeside::bytesFor(static_cast<double>(most)));
  EXPECT_NEAR(static_cast<double>(detector->memoryBytes()), taken, 0.1 * taken);

  std::size_t allocations = 0, dynamic = 0;
  for (int drives = 0; drives < 4; ++drives) {
    detector->reset();
    allocations = testing::allocations();
    for (const Scan& cloud : clouds) {
      detector->process(cloud, labels);
      dynamic += static_cast<std::size_t>(std::count(labels.dynamic.begin(), labels.dynamic.end(), 1));
    }
  }
  // Traces of parts take turns with storage of different sizes: now and then one of them grows.
  EXPECT_LE(testing::allocations() - allocations, clouds.size() / 20);
  EXPECT_GT(dynamic, 1000U);
}

INSTANTIATE_TEST_SUITE_P(Grids, LabelsOfParts, ::testing::Values(Method::kDonex3d, Method::kDonex2d));

}  // namespace
}  // namespace donex
