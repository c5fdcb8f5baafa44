#include "plant/imu_clock.h"

#include <gtest/gtest.h>

#include <cmath>

namespace flinch {
namespace {

TEST(ImuClock, TicksWithTheControllerUnlessItIsToldOtherwise) {
  const ImuClock clock(ImuClockSettings{}, 7);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_EQ(clock.sample(i).measured, i * 1ms);
    EXPECT_EQ(clock.sample(i).stamp, i * 1ms);
  }
}

TEST(ImuClock, KeepsItsRateAndItsLeadOverTheTick) {
  const ImuClock clock({.period = 625us, .before_tick = 200us}, 7);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(clock.sample(i).measured, i * 625us - 200us);
}

TEST(ImuClock, IsOffByItsJitterAtMostAndInTheMeanNotAtAll) {
  const ImuClockSettings settings{
      .period = 625us, .before_tick = 100us, .jitter = 120us, .stamp_jitter = 150us};
  const ImuClock clock(settings, 7);
  constexpr int samples = 20000;
  double sum = 0.0, squares = 0.0, of_stamps = 0.0;
  for (int i = 0; i < samples; ++i) {
    const ImuClock::Sample sample = clock.sample(i);
    const double off = to_seconds(sample.measured - (i * 625us - 100us));
    const double said = to_seconds(sample.stamp - sample.measured);
    EXPECT_LE(std::abs(off), 120e-6);
    EXPECT_LE(std::abs(said), 150e-6);
    sum += off + said;
    squares += off * off;
    of_stamps += said * said;
    EXPECT_GT(clock.sample(i + 1).stamp, sample.stamp);
  }
  EXPECT_NEAR(sum / samples, 0.0, 4e-6);
  EXPECT_NEAR(std::sqrt(squares / samples), 120e-6 / std::sqrt(3.0), 1e-6);
  EXPECT_NEAR(std::sqrt(of_stamps / samples), 150e-6 / std::sqrt(3.0), 1.5e-6);
}

TEST(ImuClock, LetsNoSampleOvertakeAnotherAndBelievesInTheUsualDelay) {
  constexpr Time period = 625us, most = 500us;
  const ImuClock clock({.period = period, .delay_jitter = most}, 7);
  constexpr int samples = 20000;
  double sum = 0.0, squares = 0.0;
  int as_drawn = 0;
  for (int i = 0; i < samples; ++i) {
    const ImuClock::Sample sample = clock.sample(i), next = clock.sample(i + 1);
    EXPECT_EQ(sample.measured, i * period);
    EXPECT_EQ(sample.stamp, sample.measured + sample.late) << "when it came, less the usual delay";
    EXPECT_LE(abs(sample.late), most);
    EXPECT_LE(sample.measured + sample.late, next.measured + next.late);
    const double late = to_seconds(sample.late);
    sum += late, squares += late * late;
    as_drawn += next.measured + next.late > sample.measured + sample.late ? 1 : 0;
  }
  EXPECT_GT(as_drawn, samples * 9 / 10) << "few wait for the one before";
  EXPECT_NEAR(sum / samples, 0.0, 4e-5) << "these a little longer";
  EXPECT_NEAR(std::sqrt(squares / samples), 500e-6 / std::sqrt(3.0), 3e-5);
}

TEST(ImuClock, IsTheSameForTheSameSeedOnly) {
  const ImuClockSettings settings{.jitter = 100us};
  const ImuClock a(settings, 5), b(settings, 5), c(settings, 6);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(a.sample(i).measured, b.sample(i).measured);
    EXPECT_NE(a.sample(i).measured, c.sample(i).measured);
  }
}

TEST(ImuClock, KnowsASampleThatIsNotLaterThanTheFirstOneAfterATime) {
  const ImuClockSettings settings{.period = 417us, .before_tick = 300us, .jitter = 200us};
  const ImuClock clock(settings, 7);
  for (Time time = -2ms; time < 200ms; time += 137us) {
    const std::int64_t number = clock.number_at(time);
    EXPECT_LE(clock.sample(number - 1).measured, time);
    EXPECT_GT(clock.sample(number + 4).measured, time);
  }
}

TEST(ImuClock, RefusesJitterThatWouldMixUpSamples) {
  EXPECT_TRUE(problems(ImuClockSettings{.jitter = 200us, .stamp_jitter = 299us}).empty());
  EXPECT_EQ(problems(ImuClockSettings{.jitter = 200us, .stamp_jitter = 300us}).size(), 1U);
  EXPECT_EQ(problems(ImuClockSettings{.before_tick = 1ms}).size(), 1U);
  EXPECT_EQ(problems(ImuClockSettings{.period = -1ms, .jitter = -1us}).size(), 2U);
}

}  // namespace
}  // namespace flinch
