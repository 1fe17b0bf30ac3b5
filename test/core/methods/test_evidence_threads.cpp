// The default configuration on several threads gives what it gives on one.
#include <map>
#include <tuple>

#include <gtest/gtest.h>

#include "donex/detector.h"
#include "support/sectors.h"
#include "support/simulated_drive.h"

namespace donex {
namespace {

constexpr int kScans = 14;
constexpr double kPeriod = 0.1;  // [s]

/// Traffic and pedestrians at a crossing, each turn in so many parts; made once.
const std::vector<Scan>& crossing(std::size_t parts) {
  static std::map<std::size_t, std::vector<Scan>> made;
  std::vector<Scan>& scans = made[parts];
  if (!scans.empty()) return scans;
  for (const testing::TrueScan& turn : testing::simulatedDrive("intersection", 64, kScans)) {
    for (Scan& part : testing::sectorsOf(turn.scan, parts, kPeriod)) scans.push_back(std::move(part));
  }
  return scans;
}

void expectSame(const Object& object, const Object& expected) {
  EXPECT_EQ(object.id, expected.id);
  EXPECT_EQ(object.odom_from_box.matrix(), expected.odom_from_box.matrix());
  EXPECT_EQ(object.size, expected.size);
  EXPECT_EQ(object.velocity, expected.velocity);
  EXPECT_EQ(object.dynamic, expected.dynamic);
  EXPECT_EQ(object.proof, expected.proof);
  EXPECT_EQ(object.age, expected.age);
  EXPECT_EQ(object.echoes, expected.echoes);
}

using Setting = std::tuple<Method, std::size_t, int, bool>;

class EvidenceThreads : public ::testing::TestWithParam<Setting> {};

TEST_P(EvidenceThreads, ChangeNothing) {
  const auto [method, parts, threads, finds_objects] = GetParam();
  Config config;
  config.method = method;
  config.objects.enabled = finds_objects;
  const auto alone = makeDetector(config);
  config.threads = threads;
  const auto together = makeDetector(config);
  EchoLabels expected, labels;
  std::size_t dynamic = 0, objects = 0;
  for (const Scan& scan : crossing(parts)) {
    alone->process(scan, expected);
    together->process(scan, labels);
    ASSERT_EQ(labels.dynamic, expected.dynamic) << scan.stamp;
    ASSERT_EQ(labels.observed, expected.observed) << scan.stamp;
    ASSERT_EQ(together->reasons(), alone->reasons());
    ASSERT_EQ(together->proofs(), alone->proofs());
    ASSERT_EQ(together->dynamicCells(), alone->dynamicCells());
    ASSERT_EQ(together->objects().size(), alone->objects().size());
    for (std::size_t i = 0; i < alone->objects().size(); ++i) expectSame(together->objects()[i], alone->objects()[i]);
    for (const std::uint8_t label : labels.dynamic) dynamic += label;
    objects += together->objects().size();
  }
  EXPECT_EQ(together->memoryCells().shadowed, alone->memoryCells().shadowed);
  EXPECT_EQ(together->memoryCells().seen_through, alone->memoryCells().seen_through);
  EXPECT_GT(dynamic, 1000U);
  EXPECT_EQ(objects > 10U, finds_objects);
}

const auto kBothGrids = ::testing::Values(Method::kDonex2d, Method::kDonex3d);

INSTANTIATE_TEST_SUITE_P(WholeAndParts, EvidenceThreads,
                         ::testing::Combine(kBothGrids, ::testing::Values(std::size_t{1}, std::size_t{4}),
                                            ::testing::Values(2, 3), ::testing::Values(true)));
INSTANTIATE_TEST_SUITE_P(WithoutObjects, EvidenceThreads,
                         ::testing::Combine(kBothGrids, ::testing::Values(std::size_t{1}), ::testing::Values(2),
                                            ::testing::Values(false)));

}  // namespace
}  // namespace donex
