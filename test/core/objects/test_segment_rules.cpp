// What a segment's extent and places say of it, at the limits.
#include <gtest/gtest.h>

#include "core/objects/segment_rules.h"

namespace donex {
namespace {

const SegmentRules kRules{ObjectConfig{}};

Segment boxOf(double length, double height, float lowest) {
  Segment segment;
  segment.high = {0.1, length, height};
  segment.lowest = lowest;
  return segment;
}

TEST(SegmentRules, ARailHasNoRear) {
  EXPECT_FALSE(kRules.hasRear(boxOf(3.1, 0.5, 0.3F)));
  EXPECT_TRUE(kRules.hasRear(boxOf(2.9, 0.5, 0.3F))) << "as short as a car that two beams hit";
  EXPECT_TRUE(kRules.hasRear(boxOf(12.0, 0.7, 0.3F))) << "the side of a lorry";
}

TEST(SegmentRules, OneBeamHighUpIsNoRear) {
  EXPECT_FALSE(kRules.hasRear(boxOf(1.5, 0.1, 0.9F)));
  EXPECT_TRUE(kRules.hasRear(boxOf(1.5, 0.1, 0.7F))) << "a bumper";
  EXPECT_TRUE(kRules.hasRear(boxOf(1.5, 0.2, 0.9F))) << "two beams";
}

Segment newOf(int echoes, int lingering) {
  Segment segment;
  segment.new_echoes = echoes;
  segment.lingering_echoes = lingering;
  return segment;
}

TEST(SegmentRules, FreshEchoesAreATenthOfTheNewOnesAndFiveAtLeast) {
  EXPECT_TRUE(kRules.isFresh(newOf(100, 90)));
  EXPECT_FALSE(kRules.isFresh(newOf(100, 91)));
  EXPECT_TRUE(kRules.isFresh(newOf(5, 0)));
  EXPECT_FALSE(kRules.isFresh(newOf(20, 16))) << "four, though that is a fifth";
}

}  // namespace
}  // namespace donex
