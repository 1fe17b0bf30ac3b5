// A sensor at rest: labels are of use from the first second on.
#include <gtest/gtest.h>

#include "donex/detector.h"
#include "support/simulated_drive.h"

namespace donex {
namespace {

TEST(StartUp, UsefulFromTheFirstSecondAtRest) {
  constexpr std::size_t kFirst = 5, kEnd = 10;  // scans: the second half of the first second
  const auto drive = testing::simulatedDrive("intersection", 32, static_cast<int>(kEnd));
  const auto detector = makeDetector(Config());
  testing::Score score;
  for (std::size_t k = 0; k < kEnd; ++k) {
    EchoLabels labels;
    detector->process(drive[k].scan, labels);
    if (k >= kFirst) score.add(drive[k], labels);
  }
  RecordProperty("recall", std::to_string(score.recall()));
  RecordProperty("precision", std::to_string(score.precision()));
  EXPECT_GT(score.recall(), 0.7);
  EXPECT_GT(score.precision(), 0.95);
}

}  // namespace
}  // namespace donex
