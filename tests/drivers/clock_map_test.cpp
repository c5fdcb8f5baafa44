#include "drivers/clock_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "drivers/tick_clock.h"
#include "systems/framework/random.h"

namespace flinch {
namespace {

/// Mostly 30 us, sometimes milliseconds.
Time random_delay(RandomGenerator& random) {
  const Time usual = from_seconds(30e-6 + 20e-6 * random.uniform(0.0, 1.0));
  return random.uniform(0.0, 1.0) < 0.05 ? usual + from_seconds(4e-3 * random.uniform(0.0, 1.0)) : usual;
}

TEST(ClockMap, TellsTheOtherClockUpToTheSmallestDelayWhateverTheJitter) {
  for (const Time offset : {Time(0), Time(12345h), Time(-777s)}) {
    RandomGenerator random(1);
    ClockMap map;
    for (Time t = 0ms; t < 20s; t += 1ms) {
      map.observe(t - offset, t + random_delay(random));
      if (t < 100ms) continue;
      const Time error = map.to_here(t - offset) - t;
      EXPECT_GE(error, 30us);
      EXPECT_LE(error, 45us);
    }
  }
}

TEST(ClockMap, KeepsUpWithAClockThatRunsSlowOrFast) {
  for (const double drift : {-80e-6, 80e-6}) {
    RandomGenerator random(2);
    ClockMap map;
    for (Time t = 0ms; t < 60s; t += 1ms) {
      const Time there = from_seconds(to_seconds(t) * (1.0 + drift));
      map.observe(there, t + random_delay(random));
      if (t < 100ms) continue;
      EXPECT_LE(std::abs((map.to_here(there) - t).count()), 60'000) << t.count();
    }
  }
}

TEST(ClockMap, KeepsTheSpacingOfStampsThroughALateArrival) {
  ClockMap map;
  for (Time t = 0ms; t < 100ms; t += 1ms) map.observe(t, t + 1s);
  const Time before = map.to_here(99ms);
  map.observe(100ms, 1s + 100ms + 7ms);
  EXPECT_LE(map.to_here(100ms) - before - 1ms, 2us);
}

TEST(ClockMap, MapsBackToWhereItCameFrom) {
  ClockMap map;
  map.observe(5s, 9s);
  EXPECT_EQ(map.to_there(map.to_here(5100ms)), 5100ms);
}

TEST(TickClock, TellsTickTimesUpToTheMostPunctualStart) {
  RandomGenerator random(3);
  TickClock clock(1ms);
  const Time start = 1234s;
  for (Time t = 0ms; t < 5s; t += 1ms) {
    clock.start_tick(t, start + t + from_seconds(0.8e-3 * random.uniform(0.0, 1.0)));
    if (t < 1s) continue;
    EXPECT_NEAR(to_seconds(clock.to_tick_time(start + t - 3ms)), to_seconds(t - 3ms), 60e-6);
  }
}

TEST(TickClock, NeverTellsATimeAfterTheTick) {
  TickClock clock(1ms);
  clock.start_tick(10ms, 5s);
  EXPECT_EQ(clock.to_tick_time(6s), 10ms);
}

TEST(TickClock, FallsBehindTheClockByTheWholePeriodsThatWereLostWithoutAJump) {
  TickClock clock(1ms);
  for (int k = 0; k <= 10; ++k) clock.start_tick(k * 1ms, 5s + k * 1ms);
  Time last = clock.to_monotonic(10ms);
  clock.start_tick(11ms, 5s + 11ms + 2300us);  // two periods lost
  for (int k = 11; k <= 1000; ++k) {
    if (k > 11) clock.start_tick(k * 1ms, 5s + k * 1ms + 2ms);
    const Time told = clock.to_monotonic(k * 1ms);
    EXPECT_GE(told - last, 1ms);
    EXPECT_LE(told - last, 1011us);
    last = told;
  }
  EXPECT_NEAR(to_seconds(last), 5.0 + 1.0 + 2e-3, 1e-6);
}

TEST(TickClock, CatchesUpAtOnceWithMoreThanTwoLostPeriods) {
  TickClock clock(1ms);
  for (int k = 0; k <= 10; ++k) clock.start_tick(k * 1ms, 5s + k * 1ms);
  clock.start_tick(11ms, 5s + 11ms + 7300us);
  clock.start_tick(12ms, 5s + 12ms + 7ms);
  EXPECT_NEAR(to_seconds(clock.to_monotonic(12ms)), 5.0 + 19e-3, 1e-6);
}

TEST(TickClock, NeverFallsFurtherBehindHoweverOftenPeriodsAreLost) {
  TickClock clock(1ms);
  Time lost{};
  for (int k = 0; k <= 5000; ++k) {
    if (k % 20 == 19) lost += 1ms;
    const Time now = 5s + k * 1ms + lost;
    clock.start_tick(k * 1ms, now);
    EXPECT_LE(now - clock.to_monotonic(k * 1ms), 2ms + 1us);
  }
}

TEST(TickClock, BeginsANewRunWhereTheTimeOfTicksFallsBack) {
  TickClock clock(1ms);
  for (int k = 0; k <= 10; ++k) clock.start_tick(k * 1ms, 5s + k * 1ms);
  clock.start_tick(0ms, 8s);
  EXPECT_EQ(clock.to_monotonic(0ms), 8s);
}

}  // namespace
}  // namespace flinch
