// When ticks start, and what becomes of those that cannot start when they are due.
#include <gtest/gtest.h>

#include "systems/framework/random.h"
#include "systems/framework/realtime_runner.h"
#include "tests/support/blocks.h"
#include "tests/systems/framework/realtime_station.h"

namespace flinch {
namespace {

using test::Calls;
using test::FakeClockTicks;
using test::Station;

/// The timings that a run had, tick by tick.
std::vector<TickTiming> run_ticks(TickSource& source, int ticks, const std::function<void(int)>& work) {
  const Station station = Station::build();
  std::vector<TickTiming> timings;
  Calls exchange;
  exchange.before = [&](Context& context) { timings.push_back(context.get(station.timing)); };
  exchange.after = [&](const Context&) { work(static_cast<int>(timings.size()) - 1); };
  RealtimeRunner runner(*station.diagram, source, exchange);
  runner.feed_timing(station.timing);
  Context context = station.diagram->make_context();
  runner.run(context, ticks * 1ms);
  EXPECT_EQ(context.time(), Time(ticks * 1ms));
  return timings;
}

// ---------------------------------------------------------------- laws

TEST(RealtimeRunner, StartsAtMostOneTickInAPeriodAndAccountsForEveryPeriod) {
  FakeClockTicks ticks;
  RandomGenerator random(2);
  const Time start = ticks.now();
  const std::vector<TickTiming> timings = run_ticks(ticks, 2000, [&](int) {
    ticks.work(from_seconds(random.uniform(0.0, random.uniform(0.0, 1.0) < 0.9 ? 0.5e-3 : 6e-3)));
    ticks.wake_delay = from_seconds(random.uniform(0.0, random.uniform(0.0, 1.0) < 0.9 ? 0.1e-3 : 4e-3));
  });
  std::int64_t lost = 0;
  for (std::size_t k = 0; k < timings.size(); ++k) {
    const auto ticks_and_lost_before = static_cast<std::int64_t>(k) + lost;
    EXPECT_EQ(timings[k].lateness, timings[k].started - (start + ticks_and_lost_before * 1ms));
    lost += timings[k].lost_periods;
    EXPECT_EQ((timings[k].started - start) / 1ms, static_cast<std::int64_t>(k) + lost);
  }
  EXPECT_GT(lost, 0);
}

// ---------------------------------------------------------------- late ticks, by the clock

TEST(RealtimeRunner, StartsATickAtOnceThatAnOverrunMadeLateAndKeepsTheSchedule) {
  FakeClockTicks ticks;
  const Time start = ticks.now();
  const auto timings = run_ticks(ticks, 5, [&](int tick) { ticks.work(tick == 1 ? 1700us : 200us); });
  EXPECT_EQ(timings[2].started, start + 2700us);
  EXPECT_EQ(timings[2].lateness, Time(700us));
  EXPECT_TRUE(timings[2].late);
  EXPECT_EQ(timings[2].lost_periods, 0);
  EXPECT_EQ(timings[3].started, start + 3ms);
  EXPECT_FALSE(timings[3].late);
}

TEST(RealtimeRunner, CountsPeriodsThatPassedWithoutATickAsLostAndKeepsThePhase) {
  FakeClockTicks ticks;
  const Time start = ticks.now();
  const auto timings = run_ticks(ticks, 5, [&](int tick) { ticks.work(tick == 1 ? 3300us : 200us); });
  EXPECT_EQ(timings[2].started, start + 4300us);
  EXPECT_EQ(timings[2].lateness, Time(2300us));
  EXPECT_EQ(timings[2].lost_periods, 2);
  EXPECT_EQ(timings[3].started, start + 5ms);
  EXPECT_EQ(timings[3].lateness, Time(0));
}

TEST(RealtimeRunner, RunsWhatWasDueInALostPeriodAtTheNextTickOfATimeThatFollowsTheClock) {
  DiagramBuilder builder("loop", 1ms);
  auto& counter = builder.add<test::Counter>("counter");
  auto& slow = builder.add<test::Delay>("slow", Every{5ms});
  builder.connect(counter.count, slow.in);
  const auto diagram = builder.build();
  FakeClockTicks ticks;
  Calls exchange;
  std::vector<Time> times;
  std::vector<double> held;
  exchange.after = [&](const Context& context) {
    times.push_back(context.time());
    held.push_back(context.get(slow.out));
    ticks.work(context.time() == 4ms ? 3300us : 100us);  // no tick at 5 ms and 6 ms
  };
  RealtimeRunner runner(*diagram, ticks, exchange);
  runner.follow_clock();
  Context context = diagram->make_context();
  runner.run(context, 13ms);
  EXPECT_EQ(times, (std::vector<Time>{0ms, 1ms, 2ms, 3ms, 4ms, 7ms, 8ms, 9ms, 10ms, 11ms, 12ms}));
  // What was due at 5 ms ran at 7 ms, the sixth tick; what was due at 10 ms then.
  EXPECT_EQ(held, (std::vector<double>{0, 0, 0, 0, 0, 0, 5, 5, 5, 8, 8}));
}

TEST(RealtimeRunner, TellsATickHowLongTheOneBeforeTook) {
  FakeClockTicks ticks;
  const auto timings = run_ticks(ticks, 3, [&](int tick) { ticks.work(tick == 1 ? 1001us : 1000us); });
  EXPECT_TRUE(timings[0].valid);
  EXPECT_FALSE(timings[0].previous.valid);
  EXPECT_TRUE(timings[1].previous.valid);
  EXPECT_EQ(timings[1].previous.evaluation, Time(1000us));
  EXPECT_EQ(timings[1].previous.update, Time(0));
  EXPECT_EQ(timings[1].previous.whole, Time(1000us));
  EXPECT_FALSE(timings[1].previous.overran);
  EXPECT_TRUE(timings[2].previous.overran);
}

TEST(RealtimeRunner, CallsATickLateOnlyBeyondHalfAMillisecond) {
  FakeClockTicks ticks;
  ticks.wake_delay = 500us;
  const auto timings = run_ticks(ticks, 2, [&](int) { ticks.wake_delay = 501us; });
  EXPECT_FALSE(timings[0].late);
  EXPECT_TRUE(timings[1].late);
}

}  // namespace
}  // namespace flinch
