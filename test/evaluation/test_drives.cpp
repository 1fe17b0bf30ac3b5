// The fast grids against the oracle, and the default configuration's labels, on whole drives: real ones
// where DONEX_SHARED_DATA names a folder of sequences, and always a simulated one.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "core/evidence/ground.h"
#include "donex/detector.h"
#include "evaluation/evaluation.h"
#include "evaluation/scan_parts.h"
#include "io/sequence.h"
#include "simulation/simulator.h"
#include "support/ground_oracle.h"
#include "support/oracle.h"

namespace donex {
namespace {

struct LabelledScan {
  Scan scan;
  std::vector<std::uint32_t> labels;  ///< empty where there are none
};

/// Up to `most` scans of a sequence in the SemanticKITTI layout, or of a simulated scene.
std::vector<LabelledScan> drive(const std::string& name, std::size_t most) {
  std::vector<LabelledScan> scans;
  if (std::filesystem::is_directory(name)) {
    const SequenceReader reader(name);
    for (std::size_t i = 0; i < std::min(most, reader.size()); ++i) {
      scans.push_back({toScan(reader.scan(i)), {}});
      if (reader.hasLabels(i)) scans.back().labels = reader.labels(i);
    }
    return scans;
  }
  simulation::Simulator simulator(name);
  simulation::SimulatedScan scan;
  while (scans.size() < most && simulator.next(scan)) scans.push_back({scan.coreScan(), scan.labels});
  return scans;
}

std::vector<std::string> drives() {
  std::vector<std::string> names{"street"};
  const char* folder = std::getenv("DONEX_SHARED_DATA");
  if (folder == nullptr || !std::filesystem::is_directory(folder)) return names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (std::filesystem::is_directory(entry.path() / "velodyne")) names.push_back(entry.path().string());
  }
  return names;
}

class Drives : public ::testing::TestWithParam<std::string> {};

Scan thinned(const Scan& scan, std::size_t step) {
  Scan thin = scan;
  thin.echoes.clear();
  for (std::size_t i = 0; i < scan.echoes.size(); i += step) thin.echoes.push_back(scan.echoes[i]);
  return thin;
}

template <class Oracle>
void expectOracleLabels(Method method, const std::vector<LabelledScan>& scans) {
  for (const Compensation compensation : {Compensation::kScroll, Compensation::kResample}) {
    Config config = paperConfig(method);
    config.compensation = compensation;
    config.voxel_size = 0.4;
    Oracle oracle(config);
    const auto detector = makeDetector(config);
    std::size_t dynamic = 0;
    for (const LabelledScan& labelled : scans) {
      const Scan scan = thinned(labelled.scan, 8);  // the oracle walks every line of sight
      EchoLabels labels;
      detector->process(scan, labels);
      ASSERT_EQ(labels.dynamic, oracle.process(scan));
      for (const std::uint8_t label : labels.dynamic) dynamic += label;
    }
    EXPECT_GT(dynamic, 0U);
  }
}

TEST_P(Drives, Paper3dGivesTheOraclesLabels) {
  expectOracleLabels<oracle::Donex3d>(Method::kDonex3d, drive(GetParam(), 4));
}

TEST_P(Drives, Paper2dGivesTheOraclesLabels) {
  expectOracleLabels<oracle::Donex2d>(Method::kDonex2d, drive(GetParam(), 10));
}

/// Cut into sectors, with nothing that tells so, whole drives have the same labels by the paper's rule.
void expectLabelsOfWholeScans(Method method, const std::vector<LabelledScan>& scans) {
  constexpr double kPeriod = 0.1;  // [s]
  const Config config = paperConfig(method);
  const auto whole = makeDetector(config), in_parts = makeDetector(config);
  ScanParts parts(10);
  EchoLabels expected, labels, of_part;
  for (const LabelledScan& labelled : scans) {
    whole->process(labelled.scan, expected);
    labels.assign(labelled.scan.echoes.size());
    parts.cut(labelled.scan, kPeriod);
    for (std::size_t part = 0; part < parts.count(); ++part) {
      in_parts->process(parts[part], of_part);
      parts.putBack(part, of_part, labels);
    }
    ASSERT_EQ(labels.dynamic, expected.dynamic);
    ASSERT_EQ(labels.observed, expected.observed);
  }
}

TEST_P(Drives, PaperOnPartsGivesTheLabelsOfWholeScans) {
  const std::vector<LabelledScan> scans = drive(GetParam(), 10);
  expectLabelsOfWholeScans(Method::kDonex3d, scans);
  expectLabelsOfWholeScans(Method::kDonex2d, scans);
}

TEST_P(Drives, TheGroundIsThatOfItsDefinition) {
  constexpr double kReach = 60.0;
  Ground ground(kReach);
  for (const LabelledScan& labelled : drive(GetParam(), 2)) {
    const std::vector<Eigen::Vector3f>& echoes = labelled.scan.echoes;
    std::vector<std::uint8_t> is_echo(echoes.size());
    for (std::size_t i = 0; i < echoes.size(); ++i) is_echo[i] = echoes[i].allFinite() ? 1 : 0;
    ground.estimate(Eigen::Vector3f::Zero(), echoes, is_echo);
    oracle::GroundMap map(kReach, Eigen::Vector3f::Zero(), echoes, is_echo);
    std::size_t judged = 0;
    for (std::size_t i = 0; i < echoes.size(); ++i) {
      const double expected = map.heightOf(echoes[i]);
      if (is_echo[i] == 0 || std::isinf(expected)) continue;
      ASSERT_NEAR(ground.heightOf(echoes[i]), expected, 1e-3) << "echo " << i;
      ++judged;
    }
    EXPECT_GT(judged, 10000U);
  }
}

/// What the default configuration reaches at least in the first scans of a drive, on either grid.
struct Reached {
  std::size_t moving_echoes;
  double iou, precision;
};

/// The precision of kitti_0001 is the known weakness of the labels (docs/results.md): its bounds only notice when it
/// gets worse.
Reached leastOf(const std::string& drive) {
  const std::string name = std::filesystem::path(drive).filename().string();
  if (name == "kitti_0001") return {100, 0.30, 0.32};
  return {1000, 0.93, 0.98};
}

TEST_P(Drives, TheDefaultConfigurationFindsWhatMoves) {
  const Reached least = leastOf(GetParam());
  const auto scans = drive(GetParam(), 40);
  for (const Method method : {Method::kDonex3d, Method::kDonex2d}) {
    Config config;
    config.method = method;
    const auto detector = makeDetector(config);
    Evaluation evaluation;
    for (std::size_t k = 0; k < scans.size(); ++k) {
      EchoLabels labels;
      detector->process(scans[k].scan, labels);
      if (scans[k].labels.empty() || !evaluation.scores(k)) continue;
      evaluation.add(k, scans[k].scan.echoes, scans[k].labels, asSemanticKitti(labels));
    }
    if (evaluation.scans() == 0) GTEST_SKIP() << "no labels";
    ASSERT_GT(evaluation.total().moving(), least.moving_echoes);
    EXPECT_GT(evaluation.total().iou(), least.iou);
    EXPECT_GT(evaluation.total().precision(), least.precision);
  }
}

/// GoogleTest wants letters, digits and underscores.
std::string nameOf(const ::testing::TestParamInfo<std::string>& tested) {
  std::string name = std::filesystem::path(tested.param).filename().string();
  const auto is_odd = [](unsigned char c) { return std::isalnum(c) == 0; };
  std::replace_if(name.begin(), name.end(), is_odd, '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(All, Drives, ::testing::ValuesIn(drives()), nameOf);

}  // namespace
}  // namespace donex
