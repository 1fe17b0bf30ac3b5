// What several threads do together: everything, once.
#include <atomic>
#include <vector>

#include <gtest/gtest.h>

#include "core/grid/workers.h"

namespace donex {
namespace {

class WorkersOf : public ::testing::TestWithParam<int> {};

TEST_P(WorkersOf, StretchesCoverEachEntryOnce) {
  const Workers workers(GetParam());
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, kStretch - 1, kStretch, 5 * kStretch + 7}) {
    std::vector<int> visits(count, 0);
    std::atomic<int> stretches{0};
    forEachStretch(workers, count, [&](std::size_t first, std::size_t last) {
      EXPECT_EQ(first % kStretch, 0U);
      for (std::size_t i = first; i < last; ++i) ++visits[i];
      ++stretches;
    });
    EXPECT_EQ(visits, std::vector<int>(count, 1));
    EXPECT_EQ(stretches, static_cast<int>((count + kStretch - 1) / kStretch));
  }
}

TEST_P(WorkersOf, BothStepsAreDone) {
  const Workers workers(GetParam());
  for (int round = 0; round < 100; ++round) {
    int first = 0, second = 0;
    workers.both([&] { first = round; }, [&] { second = -round; });
    ASSERT_EQ(first, round);
    ASSERT_EQ(second, -round);
  }
}

INSTANTIATE_TEST_SUITE_P(Threads, WorkersOf, ::testing::Values(1, 2, 3));

}  // namespace
}  // namespace donex
