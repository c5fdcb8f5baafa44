#include "systems/framework/realtime_runner.h"

#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <mutex>
#include <thread>

#include "systems/foundation/setup_error.h"
#include "systems/framework/block_profile.h"
#include "systems/framework/diagram_builder.h"
#include "systems/framework/exchange.h"
#include "systems/framework/random.h"
#include "systems/framework/recorder.h"
#include "systems/framework/sample_signal.h"
#include "systems/framework/triple_buffer.h"
#include "tests/support/allocations.h"
#include "tests/support/locks.h"
#include "tests/support/sanitized.h"
#include "tests/systems/framework/realtime_station.h"

namespace flinch {
namespace {

using test::Calls;
using test::FakeClockTicks;
using test::Station;
using test::TimingView;

// ---------------------------------------------------------------- laws

std::vector<std::string> all_but_timing(const Diagram& diagram) {
  std::vector<std::string> paths = recordable_paths(diagram);
  std::erase_if(paths, [](const std::string& path) { return path == "timing" || path == "view/seen"; });
  return paths;
}

/// What a recorder saw of 500 ticks with the input sin(0.1 k), as `run` runs them.
template <class Run>
Recording record(const Station& station, Run&& run) {
  Recorder recorder(*station.diagram, all_but_timing(*station.diagram), 500);
  Context context = station.diagram->make_context();
  run(recorder, context);
  return recorder.recording();
}

void set_push(const Station& station, Context& context) {
  context.set(station.push, std::sin(100.0 * to_seconds(context.time())));
}

TEST(RealtimeRunner, ComputesTheSameBitsAsSimulatorHoweverLateItsTicksAre) {
  const Station station = Station::build();
  const Recording simulated = record(station, [&](Recorder& recorder, Context& context) {
    Simulator simulator(*station.diagram);
    simulator.record(recorder);
    for (int k = 0; k < 500; ++k) {
      set_push(station, context);
      simulator.step(context);
    }
  });
  const Recording realtime = record(station, [&](Recorder& recorder, Context& context) {
    FakeClockTicks ticks;
    RandomGenerator random(1);
    Calls exchange;
    exchange.before = [&](Context& now) { set_push(station, now); };
    exchange.after = [&](const Context&) { ticks.work(from_seconds(random.uniform(0.0, 5e-3))); };
    RealtimeRunner runner(*station.diagram, ticks, exchange);
    runner.record(recorder);
    runner.run(context, 500ms);
  });
  EXPECT_EQ(realtime.time_ns, simulated.time_ns);
  ASSERT_EQ(realtime.signals.size(), simulated.signals.size());
  for (std::size_t i = 0; i < realtime.signals.size(); ++i) {
    const Signal& one = realtime.signals[i];
    const Signal& other = simulated.signals[i];
    ASSERT_EQ(one.rows.size(), other.rows.size());
    EXPECT_EQ(std::memcmp(one.rows.data(), other.rows.data(), one.rows.size() * sizeof one.rows[0]), 0)
        << one.path;
  }
}

TEST(RealtimeRunner, CountsInItsStatisticsWhatItsTimingsTell) {
  const Station station = Station::build();
  FakeClockTicks ticks;
  RandomGenerator random(3);
  Calls exchange;
  std::int64_t late = 0, lost = 0, overran = 0;
  exchange.before = [&](Context& context) {
    const TickTiming& timing = context.get(station.timing);
    late += timing.late ? 1 : 0;
    lost += timing.lost_periods;
    overran += timing.previous.overran ? 1 : 0;
  };
  exchange.after = [&](const Context& context) {
    if (context.time() < 999ms) ticks.work(from_seconds(random.uniform(0.0, 2e-3)));
  };
  RealtimeRunner runner(*station.diagram, ticks, exchange);
  runner.feed_timing(station.timing);
  Context context = station.diagram->make_context();
  runner.run(context, 1s);

  const TickStatistics& statistics = runner.statistics();
  EXPECT_EQ(statistics.ticks, 1000);
  EXPECT_EQ(statistics.late_starts, late);
  EXPECT_EQ(statistics.lost_periods, lost);
  EXPECT_EQ(statistics.overruns, overran);
  EXPECT_GT(late * lost * overran, 0);
  for (const DurationHistogram* each :
       {&statistics.lateness, &statistics.evaluation, &statistics.update, &statistics.whole}) {
    EXPECT_EQ(each->count(), 1000);
  }
}

// ---------------------------------------------------------------- order within a tick

TEST(RealtimeRunner, LetsOutputsLeaveBeforeRecordersAndUpdates) {
  const Station station = Station::build();
  Recorder recorder(*station.diagram, {"count"}, 10);
  FakeClockTicks ticks;
  Calls exchange;
  std::vector<double> taken;
  std::vector<std::size_t> recorded_before;
  exchange.before = [&](Context& context) { set_push(station, context); };
  exchange.after = [&](const Context& context) {
    taken.push_back(context.get(station.count));
    recorded_before.push_back(recorder.samples());
    EXPECT_EQ(context.time(), Time((taken.size() - 1) * 1ms));
    EXPECT_EQ(context.get(station.push), std::sin(100.0 * to_seconds(context.time())));
  };
  RealtimeRunner runner(*station.diagram, ticks, exchange);
  runner.record(recorder);
  Context context = station.diagram->make_context();
  runner.run(context, 4ms);
  EXPECT_EQ(taken, (std::vector<double>{0, 1, 2, 3}));
  EXPECT_EQ(recorded_before, (std::vector<std::size_t>{0, 1, 2, 3}));
}

TEST(RealtimeRunner, GoesOnWhereTheContextIs) {
  const Station station = Station::build();
  FakeClockTicks ticks;
  Exchange nothing;
  RealtimeRunner runner(*station.diagram, ticks, nothing);
  Context context = station.diagram->make_context();
  runner.run(context, 3ms);
  ticks.work(10s);  // time between two runs is nobody's lateness
  runner.run(context, 5ms);
  EXPECT_EQ(context.time(), Time(5ms));
  EXPECT_EQ(runner.statistics().ticks, 5);
  EXPECT_EQ(runner.statistics().lost_periods, 0);
}

// ---------------------------------------------------------------- timing as an input

TEST(RealtimeRunner, LetsARecordingShowEveryLateTick) {
  const Station station = Station::build();
  Recorder recorder(*station.diagram, {"view/seen"}, 10);
  FakeClockTicks ticks;
  Calls exchange;
  exchange.after = [&](const Context& context) { ticks.work(context.time() == 3ms ? 2700us : 100us); };
  RealtimeRunner runner(*station.diagram, ticks, exchange);
  runner.feed_timing(station.timing);
  runner.record(recorder);
  Context context = station.diagram->make_context();
  runner.run(context, 7ms);
  const Recording recording = recorder.recording();
  EXPECT_EQ(recording.column("view/seen", "late"), (std::vector<double>{0, 0, 0, 0, 1, 0, 0}));
  EXPECT_EQ(recording.column("view/seen", "lost_periods"), (std::vector<double>{0, 0, 0, 0, 1, 0, 0}));
  EXPECT_EQ(recording.column("view/seen", "previous.overran"), (std::vector<double>{0, 0, 0, 0, 1, 0, 0}));
}

TEST(RealtimeRunner, RefusesToFeedTimingIntoABlock) {
  DiagramBuilder builder;
  auto& view = builder.add<TimingView>("view");
  builder.export_input("timing", view.timing);
  const auto diagram = builder.build();
  FakeClockTicks ticks;
  Exchange nothing;
  RealtimeRunner runner(*diagram, ticks, nothing);
  EXPECT_THROW(runner.feed_timing(view.timing), SetupError);
}

TEST(RealtimeRunner, LetsAProfileTimeItsBlocks) {
  const Station station = Station::build();
  FakeClockTicks ticks;
  Exchange nothing;
  BlockProfile profile(*station.diagram);
  RealtimeRunner runner(*station.diagram, ticks, nothing);
  runner.profile(profile);
  Context context = station.diagram->make_context();
  runner.run(context, 7ms);
  EXPECT_EQ(profile.ticks(), 7);
}

// ---------------------------------------------------------------- stopping

TEST(RealtimeRunner, EndsAfterTheTickInWhichItWasAskedToStop) {
  const Station station = Station::build();
  FakeClockTicks ticks;
  Calls exchange;
  RealtimeRunner runner(*station.diagram, ticks, exchange);
  exchange.before = [&](Context& context) {
    if (context.time() == 5ms) runner.request_stop();
  };
  Context context = station.diagram->make_context();
  runner.run(context);
  EXPECT_EQ(context.time(), Time(6ms));
  EXPECT_EQ(context.get(station.count), 5.0);
  EXPECT_EQ(runner.statistics().ticks, 6);
  runner.run(context);  // it stays stopped
  EXPECT_EQ(context.time(), Time(6ms));
}

RealtimeRunner* stopped_by_signal = nullptr;

TEST(RealtimeRunner, StopsFromASignalHandler) {
  const Station station = Station::build();
  FakeClockTicks ticks;
  Calls exchange;
  RealtimeRunner runner(*station.diagram, ticks, exchange);
  stopped_by_signal = &runner;
  const auto before = std::signal(SIGUSR1, [](int) { stopped_by_signal->request_stop(); });
  exchange.after = [&](const Context& context) {
    if (context.time() == 2ms) std::raise(SIGUSR1);
  };
  Context context = station.diagram->make_context();
  runner.run(context);
  std::signal(SIGUSR1, before);
  EXPECT_EQ(context.time(), Time(3ms));
}

// ---------------------------------------------------------------- real threads and clocks, whatever they do

TEST(RealtimeRunner, NeitherAllocatesNorLocksInSteadyState) {
  const Station station = Station::build();
  Recorder recorder(*station.diagram, recordable_paths(*station.diagram), 100);
  BlockProfile profile(*station.diagram);
  TripleBuffer<double> received, sent;
  SampleSignal arrived;
  double latest = 0.0;
  ClockTicks ticks;
  Calls exchange;
  exchange.before = [&](Context& context) {
    if (arrived.wait_until(Time::zero())) received.take(latest);
    context.set(station.push, latest);
  };
  exchange.after = [&](const Context& context) {
    sent.publish(context.get(station.sum));
    if (context.time() % 2ms == Time::zero()) received.publish(latest + 1.0);  // every other tick
    arrived.notify();
  };
  RealtimeRunner runner(*station.diagram, ticks, exchange);
  runner.feed_timing(station.timing);
  runner.record(recorder);
  runner.profile(profile);
  Context context = station.diagram->make_context();
  runner.run(context, 2ms);

  const test::AllocationCounter allocations;
  const std::int64_t locks = test::locks();
  runner.run(context, 50ms);
  const std::int64_t locked = test::locks() - locks;
  EXPECT_EQ(allocations.count(), 0);
  EXPECT_EQ(locked, 0);
  EXPECT_EQ(recorder.samples(), 50U);
}

TEST(Locks, AreCountedByWhatTheTestAboveReliesOn) {
  std::mutex mutex;
  const std::int64_t before = test::locks();
  mutex.lock();
  mutex.unlock();
  EXPECT_EQ(test::locks() - before, test::sanitized() ? 0 : 1);
}

TEST(RealtimeRunner, RunsByTheClockBesideThreadsThatFeedAndStopIt) {
  const Station station = Station::build();
  TripleBuffer<double> received, sent;
  Calls exchange;
  double pushed = 0.0;
  exchange.before = [&](Context& context) {
    if (received.take(pushed)) context.set(station.push, pushed);
  };
  exchange.after = [&](const Context& context) { sent.publish(context.get(station.count)); };
  ClockTicks ticks;
  RealtimeRunner runner(*station.diagram, ticks, exchange);
  std::thread other([&] {
    double count = 0.0;
    for (double k = 0.0; count < 20.0; ++k) {
      received.publish(k);
      if (!sent.take(count)) std::this_thread::yield();
    }
    runner.request_stop();
  });
  const Time start = MonotonicClock::now();
  Context context = station.diagram->make_context();
  runner.run(context);
  const Time elapsed = MonotonicClock::now() - start;
  other.join();

  const TickStatistics& statistics = runner.statistics();
  EXPECT_GE(statistics.ticks, 21);
  EXPECT_EQ(context.time(), statistics.ticks * 1ms);
  EXPECT_EQ(statistics.whole.count(), statistics.ticks);
  EXPECT_GE(elapsed, (statistics.ticks - 1 + statistics.lost_periods) * 1ms);
}

}  // namespace
}  // namespace flinch
