// Numbers chosen without a branch: the same as with one.
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/grid/selection.h"

namespace donex {
namespace {

TEST(Selection, HoldsWhatTheConditionHoldsForInOrder) {
  std::mt19937 random(7);
  for (const std::size_t last : {std::size_t{0}, std::size_t{1}, kSelectionBlock, 3 * kSelectionBlock + 17}) {
    for (const unsigned one_in : {1U, 2U, 50U, 100000U}) {
      std::vector<bool> holds(last);
      for (std::size_t i = 0; i < last; ++i) holds[i] = random() % one_in == 0;
      const std::size_t first = last / 3;
      std::vector<std::uint32_t> expected, chosen;
      for (std::size_t i = first; i < last; ++i) {
        if (holds[i]) expected.push_back(static_cast<std::uint32_t>(i));
      }
      forEachSelection(
          first, last, [&](std::size_t i) { return static_cast<bool>(holds[i]); },
          [&](const std::uint32_t* block, std::size_t count) { chosen.insert(chosen.end(), block, block + count); });
      EXPECT_EQ(chosen, expected) << "of " << last << ", one in " << one_in;
    }
  }
}

}  // namespace
}  // namespace donex
