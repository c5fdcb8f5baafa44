#include "systems/signals/sample_at.h"

#include <gtest/gtest.h>

namespace flinch {
namespace {

struct Sample {
  Time acquired{};
  double value = 0.0;
};

Sample interpolated(const Around<Sample>& around, Time time) {
  return {time, around.before->value + around.share(time) * (around.after->value - around.before->value)};
}

/// Of 10, 20, 30 at 1, 2, 3 ms and of a fresh one.
std::optional<Sample> at(Time time, const Sample& fresh) {
  History<Sample, 4> past;
  for (int k = 1; k <= 3; ++k) past.push({k * 1ms, 10.0 * k});
  return sample_at(time, past, &fresh, Sampling(), interpolated);
}

TEST(SampleAt, LiesBetweenTheTwoAroundIt) {
  const Sample fresh{4ms, 40.0};
  EXPECT_DOUBLE_EQ(at(2250us, fresh)->value, 22.5);
  EXPECT_EQ(at(2250us, fresh)->acquired, 2250us);
  EXPECT_DOUBLE_EQ(at(3500us, fresh)->value, 35.0);
}

TEST(SampleAt, IsThatOfItsInstantToTheBit) {
  EXPECT_EQ(at(2ms, {4ms, 40.0})->value, 20.0);
  EXPECT_EQ(at(4ms, {4ms, 40.1})->value, 40.1);
}

TEST(SampleAt, IsTheOldestBeforeAllThatAreKnown) { EXPECT_EQ(at(500us, {4ms, 40.0})->value, 10.0); }

TEST(SampleAt, IsNoneAfterTheNewest) { EXPECT_FALSE(at(4001us, {4ms, 40.0})); }

TEST(SampleAt, IsNoneInAGap) {
  EXPECT_TRUE(at(4ms, {6ms, 60.0}));
  EXPECT_FALSE(at(4ms, {6001us, 60.0})) << "three periods and more apart";
  EXPECT_TRUE(at(6001us, {6001us, 60.0}));
}

}  // namespace
}  // namespace flinch
