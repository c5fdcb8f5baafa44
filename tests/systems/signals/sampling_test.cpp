#include "systems/signals/sampling.h"

#include <gtest/gtest.h>

namespace flinch {
namespace {

TEST(Sampling, HoldsASampleForTheLongestHoldAndNoLonger) {
  constexpr Sampling sampling;
  EXPECT_FALSE(sampling.expired(10ms, 10ms));
  EXPECT_FALSE(sampling.expired(10ms, 12ms));
  EXPECT_TRUE(sampling.expired(10ms, 12ms + 1ns));
}

TEST(Sampling, IsInterruptedWhereTheHoldWouldHaveEndedBeforeTheNextSample) {
  constexpr Sampling sampling;
  EXPECT_FALSE(sampling.interrupted(10ms, 11ms));
  EXPECT_FALSE(sampling.interrupted(10ms, 13ms));
  EXPECT_TRUE(sampling.interrupted(10ms, 14ms));
}

TEST(Sampling, HasLostASampleWhereTwoAreFurtherApartThanAnUnsteadyClockWouldPutThem) {
  constexpr Sampling sampling;
  EXPECT_FALSE(sampling.lost_between(10ms, 11ms));
  EXPECT_FALSE(sampling.lost_between(10ms, 11500us));
  EXPECT_TRUE(sampling.lost_between(10ms, 11500us + 1ns));
}

TEST(Sampling, BridgesTwoMillisecondsOrOneSample) {
  EXPECT_EQ(Sampling::each(1ms).longest_hold, Sampling().longest_hold);
  EXPECT_EQ(Sampling::each(250us).longest_hold, 2ms);
  EXPECT_FALSE(Sampling::each(4ms).expired(0ms, 4ms)) << "one sample is missing";
  EXPECT_TRUE(Sampling::each(4ms).expired(0ms, 8ms));
}

TEST(Periods, InATimeAreTheNearestCount) {
  EXPECT_EQ(periods_in(20ms, 1ms), 20);
  EXPECT_EQ(periods_in(6ms, 4ms), 2);
  EXPECT_EQ(periods_in(3ms, 4ms), 1);
  EXPECT_EQ(periods_in(1ms, 4ms, 2), 2);
  EXPECT_EQ(whole_periods(1ms, 250us), 1ms);
  EXPECT_EQ(whole_periods(1ms, 300us), 1200us);
  EXPECT_EQ(whole_periods(1ms, 4ms), 4ms);
}

}  // namespace
}  // namespace flinch
