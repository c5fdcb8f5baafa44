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
