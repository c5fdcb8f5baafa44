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

}  // namespace
}  // namespace flinch
