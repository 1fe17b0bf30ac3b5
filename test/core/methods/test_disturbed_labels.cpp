// Labels of scans with second returns: the first echoes' are those of the same scans without them.
#include <gtest/gtest.h>

#include "donex/detector.h"
#include "simulation/disturbance.h"
#include "support/simulated_drive.h"

namespace donex {
namespace {

using simulation::Disturbance;
using simulation::DisturbanceOptions;

TEST(DisturbedLabels, SecondReturnsChangeNothing) {
  constexpr int kScans = 12;
  DisturbanceOptions dual;
  dual.dual_returns = 0.2;
  const auto plain = testing::simulatedDrive("street", 32, kScans);
  const auto disturbed = testing::simulatedDrive("street", 32, kScans, 1, dual);
  const auto plain_detector = makeDetector(Config()), detector = makeDetector(Config());
  EchoLabels expected, labels;
  std::size_t moving = 0;
  for (std::size_t k = 0; k < plain.size(); ++k) {
    plain_detector->process(plain[k].scan, expected);
    detector->process(disturbed[k].scan, labels);
    ASSERT_GT(labels.dynamic.size(), expected.dynamic.size());
    std::size_t first = 0;
    for (std::size_t i = 0; i < labels.dynamic.size(); ++i) {
      const bool is_second = disturbed[k].truth[i] == Disturbance::kDisturbed;
      ASSERT_EQ(labels.dynamic[i], is_second ? 0 : expected.dynamic[first]) << "scan " << k << ", echo " << i;
      first += is_second ? 0 : 1;
      moving += labels.dynamic[i];
    }
    ASSERT_EQ(first, expected.dynamic.size());
  }
  EXPECT_GT(moving, 5000U) << "labels to be right about";
  ASSERT_TRUE(detector->measuredSensor());
  EXPECT_NEAR(detector->measuredSensor()->second_returns, 0.2 / 1.2, 0.02);
}

}  // namespace
}  // namespace donex
