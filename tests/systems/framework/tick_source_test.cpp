#include "systems/framework/tick_source.h"

#include <gtest/gtest.h>

#include <thread>

#include "systems/framework/sample_signal.h"
#include "systems/framework/triple_buffer.h"

namespace flinch {
namespace {

TEST(MonotonicClock, NeverWakesEarly) {
  for (int k = 0; k < 20; ++k) {
    const Time wanted = MonotonicClock::now() + 200us;
    MonotonicClock::sleep_until(wanted);
    EXPECT_GE(MonotonicClock::now(), wanted);
  }
}

TEST(MonotonicClock, SplitsTimesIntoSecondsAndNanoseconds) {
  const std::timespec split = MonotonicClock::to_timespec(3s + 7ns);
  EXPECT_EQ(split.tv_sec, 3);
  EXPECT_EQ(split.tv_nsec, 7);
}

TEST(ClockTicks, StartWhenDueAndAtOnceWhenThatHasPassed) {
  ClockTicks ticks;
  const Time due = ticks.now() + 1ms;
  ticks.wait(due);
  EXPECT_GE(ticks.now(), due);
  ticks.wait(due - 1s);
  EXPECT_LT(ticks.now(), due + 1s);
}

TEST(SampleSignal, RemembersWhatItWasToldBefore) {
  SampleSignal signal;
  signal.notify();
  EXPECT_TRUE(signal.wait_until(Time::zero()));
  EXPECT_FALSE(signal.wait_until(Time::zero()));
}

TEST(SampleSignal, GivesUpAtItsDeadlineNotBefore) {
  SampleSignal signal;
  const Time deadline = MonotonicClock::now() + 1ms;
  EXPECT_FALSE(signal.wait_until(deadline));
  EXPECT_GE(MonotonicClock::now(), deadline);
}

TEST(SampleSignal, WakesAThreadForEachSampleThatItThenFinds) {
  // A ping-pong: the next sample is sent only when the last was found, so that each must wake the reader.
  TripleBuffer<int> there, back;
  SampleSignal there_signal, back_signal;
  const auto receive = [](TripleBuffer<int>& buffer, SampleSignal& signal) {
    int value = -1;
    while (!buffer.take(value)) signal.wait_until(Time::max());
    return value;
  };
  constexpr int rounds = 2000;
  std::thread echo([&] {
    for (int k = 0; k < rounds; ++k) {
      back.publish(receive(there, there_signal));
      back_signal.notify();
    }
  });
  for (int k = 0; k < rounds; ++k) {
    there.publish(k);
    there_signal.notify();
    ASSERT_EQ(receive(back, back_signal), k);
  }
  echo.join();
}

}  // namespace
}  // namespace flinch
