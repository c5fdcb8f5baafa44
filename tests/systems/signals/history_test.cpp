#include "systems/signals/history.h"

#include <gtest/gtest.h>

namespace flinch {
namespace {

struct Sample {
  Time acquired{};
  int number = 0;
};

History<Sample, 4> of(int count) {
  History<Sample, 4> history;
  for (int k = 1; k <= count; ++k) history.push({k * 1ms, k});
  return history;
}

TEST(History, FindsTheSamplesAroundATime) {
  for (const int count : {4, 5, 6, 11}) {  // of which the last four are left
    const auto history = of(count);
    const Time last = count * 1ms;
    EXPECT_EQ(history.last_before(last - 500us)->number, count - 1);
    EXPECT_EQ(history.first_from(last - 500us)->number, count);
    EXPECT_EQ(history.first_from(last - 1ms)->number, count - 1);
    EXPECT_EQ(history.last_before(last - 1ms)->number, count - 2);
    EXPECT_EQ(history.first_from(last + 1ns), nullptr);
    EXPECT_EQ(history.first_from(0ms)->number, count - 3);
    EXPECT_EQ(history.last_before(last - 3ms), nullptr);
  }
}

TEST(History, KnowsBetweenWhichSamplesATimeLies) {
  const auto history = of(3);
  const auto between = history.around(2250us);
  ASSERT_TRUE(between.known());
  EXPECT_EQ(between.before->number, 2);
  EXPECT_EQ(between.after->number, 3);
  EXPECT_EQ(between.share(2250us), 0.25);
  const auto on_sample = history.around(2ms);
  EXPECT_EQ(on_sample.before, on_sample.after);
  EXPECT_EQ(on_sample.after->number, 2);
  EXPECT_FALSE(history.around(3500us).known()) << "nothing is known beyond the last sample";
  EXPECT_FALSE(history.around(500us).known()) << "nor before the first";
  const Sample fresh{4ms, 4};
  EXPECT_EQ(history.around(3500us, &fresh).after, &fresh);
  EXPECT_EQ(history.around(3500us, &fresh).before->number, 3);
  EXPECT_EQ(history.around(4ms, &fresh).before, &fresh);
  EXPECT_FALSE(history.around(4500us, &fresh).known());
}

TEST(History, HasNothingAtFirst) {
  const auto history = of(0);
  EXPECT_EQ(history.first_from(0ms), nullptr);
  EXPECT_EQ(history.last_before(1s), nullptr);
}

TEST(History, TakesNoSampleThatIsNotNewer) {
  auto history = of(3);
  history.push({3ms, 30});
  history.push({2ms, 20});
  EXPECT_EQ(history.newest().number, 3);
  EXPECT_EQ(history.count, 3U);
}

}  // namespace
}  // namespace flinch
