// Outputs that are computed on an occasion, and occasions that the time skips.
#include <gtest/gtest.h>

#include "systems/framework/diagram_builder.h"
#include "systems/framework/random.h"
#include "systems/framework/simulator.h"
#include "tests/support/allocations.h"
#include "tests/support/blocks.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

/// in - 0.5, every so often; `calls` counts how often.
class Sampled final : public System {
 public:
  explicit Sampled(Every every) : out(output<&Sampled::compute>(every, "out", in)) {}
  InputPort<double> in = input<double>("in");
  OutputPort<double> out;
  mutable int calls = 0;

 private:
  double compute(double value) const {
    ++calls;
    return value - 0.5;
  }
};

/// in + 1 whenever `wanted`.
class Triggered final : public System {
 public:
  InputPort<double> in = input<double>("in");
  InputPort<bool> wanted = input<bool>("wanted");
  OutputPort<double> out = output<&Triggered::add>(When(wanted), "out", in);

 private:
  double add(double value) const { return value + 1.0; }
};

/// 3 in; `calls` counts how often it is computed.
class CountedGain final : public System {
 public:
  InputPort<double> in = input<double>("in");
  OutputPort<double> out = output<&CountedGain::triple>("out", in);
  mutable int calls = 0;

 private:
  double triple(double value) const {
    ++calls;
    return 3.0 * value;
  }
};

// ---------------------------------------------------------------- laws

TEST(Every, IsDueWhenAnInstantLiesAfterTheTickBeforeAndNotAfterNow) {
  RandomGenerator random(1);
  for (int trial = 0; trial < 20000; ++trial) {
    const Every every{Time(1 + random() % 12), Time(random() % 20)};
    const Time now(random() % 60);
    const Time elapsed(random() % 30);
    bool expected = false;
    for (Time instant = every.offset; instant <= now; instant += every.period) {
      expected = expected || instant == now || instant > now - elapsed;
    }
    EXPECT_EQ(every.due(now, elapsed), expected) << every.period.count() << " " << every.offset.count() << " "
                                                 << now.count() << " " << elapsed.count();
  }
}

TEST(HeldOutput, IsComputedWithoutDelayWhenDueAndHoldsInBetween) {
  DiagramBuilder builder;
  auto& counter = builder.add<test::Counter>("counter");
  auto& sampled = builder.add<Sampled>("sampled", Every{4ms, 1ms});
  builder.connect(counter.count, sampled.in);
  const auto diagram = builder.build();
  Context context = diagram->make_context();
  Simulator simulator(*diagram);
  std::vector<double> seen;
  for (int k = 0; k < 10; ++k) {
    simulator.step(context);
    seen.push_back(context.get(sampled.out));
  }
  // At the first tick, and at 1, 5 and 9 ms.
  EXPECT_EQ(seen, (std::vector<double>{-0.5, 0.5, 0.5, 0.5, 0.5, 4.5, 4.5, 4.5, 4.5, 8.5}));
  EXPECT_EQ(sampled.calls, 4);
}

TEST(HeldOutput, FollowsItsConditionOfTheSameTick) {
  DiagramBuilder builder;
  auto& triggered = builder.add<Triggered>("triggered");
  const auto in = builder.export_input("in", triggered.in);
  const auto wanted = builder.export_input("wanted", triggered.wanted);
  const auto diagram = builder.build();
  Context context = diagram->make_context();
  Simulator simulator(*diagram);
  RandomGenerator random(2);
  double expected = 0.0;
  for (int k = 0; k < 1000; ++k) {
    const double value = random.normal();
    const bool now = random() % 5 == 0;
    if (k == 0 || now) expected = value + 1.0;
    // What an evaluation before the last would have held does not matter: only complete ticks do.
    context.set(in, 1e3);
    context.set(wanted, true);
    if (k % 3 == 0) diagram->evaluate(context);
    context.set(in, value);
    context.set(wanted, now);
    simulator.step(context);
    ASSERT_EQ(context.get(triggered.out), expected) << k;
  }
}

TEST(HeldOutput, LetsWhatReadsNothingElseRestAsWellWithTheSameResults) {
  DiagramBuilder builder;
  auto& counter = builder.add<test::Counter>("counter");
  auto& sampled = builder.add<Sampled>("sampled", Every{10ms});
  auto& first = builder.add<CountedGain>("first");
  auto& second = builder.add<CountedGain>("second");
  auto& sum = builder.add<test::Adder>("sum");
  auto& mixed = builder.add<test::Adder>("mixed");
  auto& after_mixed = builder.add<CountedGain>("after_mixed");
  builder.connect(counter.count, sampled.in);
  builder.connect(sampled.out, first.in);
  builder.connect(first.out, second.in);
  builder.connect(first.out, sum.a);
  builder.connect(second.out, sum.b);
  builder.connect(sum.sum, mixed.a);
  builder.connect(counter.count, mixed.b);
  builder.connect(mixed.sum, after_mixed.in);
  const auto diagram = builder.build();
  Context context = diagram->make_context();
  Simulator simulator(*diagram);
  for (int k = 0; k < 100; ++k) {
    if (k % 7 == 0) diagram->evaluate(context);
    const Context before = context;
    simulator.step(context);
    if (k % 5 == 0) simulator.step(context = before);
    const double held = k / 10 * 10 - 0.5;
    ASSERT_EQ(context.get(second.out), 9.0 * held);
    ASSERT_EQ(context.get(sum.sum), 12.0 * held);
    ASSERT_EQ(context.get(mixed.sum), 12.0 * held + k);
    ASSERT_EQ(context.get(after_mixed.out), 3.0 * (12.0 * held + k));
  }
  EXPECT_EQ(first.calls, sampled.calls);
  EXPECT_EQ(second.calls, sampled.calls);
  EXPECT_LE(sampled.calls, 10 + 10 + 2);  // ten instants, some more than once
  EXPECT_GE(after_mixed.calls, 100);
}

TEST(HeldOutput, NeverAllocates) {
  DiagramBuilder builder;
  auto& counter = builder.add<test::Counter>("counter");
  auto& sampled = builder.add<Sampled>("sampled", Every{10ms});
  builder.connect(counter.count, sampled.in);
  const auto diagram = builder.build();
  Context context = diagram->make_context();
  Simulator simulator(*diagram);
  const test::AllocationCounter allocations;
  for (int k = 0; k < 100; ++k) simulator.step(context);
  EXPECT_EQ(allocations.count(), 0);
}

// ---------------------------------------------------------------- together with states

/// Starts anew at every press: an intermediate result that is held and kept, and a condition that reads it.
class Stopwatch final : public System {
  State<Time> last_ = state<Time>("last", Time(-1s));

 public:
  InputPort<bool> press = input<bool>("press");

 private:
  Intermediate<bool> starts_ = intermediate<&Stopwatch::starts>("starts", clock, last_, press);
  Intermediate<Time> begin_ = intermediate<&Stopwatch::begin>(When(starts_), "begin", clock);

 public:
  OutputPort<Time> elapsed = output<&Stopwatch::subtract>("elapsed", clock, begin_);

 private:
  Update keep_ = keep(last_, begin_);
  bool starts(Time now, Time last, bool pressed) const { return pressed && now >= last + 3ms; }
  Time begin(Time now) const { return now; }
  Time subtract(Time now, Time begun) const { return now - begun; }
};

TEST(HeldOutput, CanBeKeptByAStateThatItsConditionReads) {
  DiagramBuilder builder;
  auto& watch = builder.add<Stopwatch>("watch");
  const auto press = builder.export_input("press", watch.press);
  const auto diagram = builder.build();
  Context context = diagram->make_context();
  Simulator simulator(*diagram);
  std::vector<Time> seen;
  for (const bool pressed : {false, false, true, true, true, true, true, false, false, true}) {
    context.set(press, pressed);
    simulator.step(context);
    seen.push_back(context.get(watch.elapsed));
  }
  // Pressed from 2 ms on, but it starts only 3 ms after the last start: at 3, 6 and 9 ms.
  EXPECT_EQ(seen, (std::vector<Time>{0ms, 1ms, 2ms, 0ms, 1ms, 2ms, 0ms, 1ms, 2ms, 0ms}));
}

TEST(HeldOutput, IsReadByDerivativesAsItWasAtTheTick) {
  // x' = held(x): at 0 and 2 ms a new slope.
  DiagramBuilder builder;
  auto& integral = builder.add<test::Decay>("integral", 0.0, 1.0);
  auto& sampled = builder.add<Sampled>("sampled", Every{2ms});
  builder.connect(integral.x, sampled.in);
  builder.connect(sampled.out, integral.push);
  const auto diagram = builder.build();
  Context context = diagram->make_context();
  Simulator(*diagram).advance_to(context, 4ms);
  const double after_two = 1.0 + 2e-3 * (1.0 - 0.5);
  EXPECT_NEAR(context.get(integral.x), after_two + 2e-3 * (after_two - 0.5), 1e-15);
}

TEST(HeldOutput, MayBeKeptBySeveralStatesAtTheirOwnTimes) {
  DiagramBuilder builder;
  auto& counter = builder.add<test::Counter>("counter");
  auto& sampled = builder.add<Sampled>("sampled", Every{2ms});
  auto& slow = builder.add<test::Delay>("slow", Every{4ms, 1ms});
  auto& fast = builder.add<test::Delay>("fast", Every{1ms});
  builder.connect(counter.count, sampled.in);
  builder.connect(sampled.out, slow.in);
  builder.connect(sampled.out, fast.in);
  const auto diagram = builder.build();
  Context context = diagram->make_context();
  Simulator simulator(*diagram);
  std::vector<double> slow_seen, fast_seen;
  for (int k = 0; k < 7; ++k) {
    simulator.step(context);
    slow_seen.push_back(context.get(slow.out));
    fast_seen.push_back(context.get(fast.out));
  }
  EXPECT_EQ(slow_seen, (std::vector<double>{0, 0, -0.5, -0.5, -0.5, -0.5, 3.5}));
  EXPECT_EQ(fast_seen, (std::vector<double>{0, -0.5, -0.5, 1.5, 1.5, 3.5, 3.5}));
}

// ---------------------------------------------------------------- time that skips periods

TEST(Diagram, RunsWhatWasDueInASkippedPeriodAtTheNextTickAndOnce) {
  DiagramBuilder builder;
  auto& counter = builder.add<test::Counter>("counter");
  auto& slow = builder.add<test::Delay>("slow", Every{10ms});
  auto& sampled = builder.add<Sampled>("sampled", Every{10ms});
  builder.connect(counter.count, slow.in);
  builder.connect(counter.count, sampled.in);
  const auto diagram = builder.build();
  Context context = diagram->make_context();
  Simulator simulator(*diagram);
  const auto tick_at = [&](Time time) {
    context.set_time(time);
    simulator.step(context);
    const double held = context.get(sampled.out);
    diagram->evaluate(context);  // shows what the update wrote
    return std::pair(context.get(slow.out), held);
  };
  EXPECT_EQ(tick_at(0ms), std::pair(0.0, -0.5));
  EXPECT_EQ(tick_at(9ms), std::pair(0.0, -0.5));  // no instant since 0 ms
  EXPECT_EQ(tick_at(13ms), std::pair(2.0, 1.5));  // 10 ms
  EXPECT_EQ(tick_at(14ms), std::pair(2.0, 1.5));
  EXPECT_EQ(tick_at(47ms), std::pair(4.0, 3.5));  // 20, 30 and 40 ms
  EXPECT_EQ(tick_at(49ms), std::pair(4.0, 3.5));
  EXPECT_EQ(tick_at(50ms), std::pair(6.0, 5.5));  // at the instant itself
  EXPECT_EQ(tick_at(51ms), std::pair(6.0, 5.5));
}

// ---------------------------------------------------------------- what build() finds

TEST(DiagramBuilder, ReportsAPeriodOfAnOutputThatTicksDoNotMeet) {
  DiagramBuilder builder("robot");
  auto& sampled = builder.add<Sampled>("sampled", Every{1500us});
  builder.export_input("in", sampled.in);
  EXPECT_EQ(test::problems_of([&] { builder.build(); }),
            (std::vector<std::string>{"the output robot/sampled/out has the period 1500000 ns, which is no "
                                      "multiple of the tick, 1000000 ns"}));
}

/// Whether in > 0.
class Positive final : public System {
 public:
  InputPort<double> in = input<double>("in");
  OutputPort<bool> out = output<&Positive::compare>("out", in);

 private:
  bool compare(double value) const { return value > 0.0; }
};

TEST(DiagramBuilder, ReportsALoopThroughACondition) {
  DiagramBuilder builder("robot");
  auto& triggered = builder.add<Triggered>("triggered");
  auto& positive = builder.add<Positive>("positive");
  builder.connect(positive.out, triggered.wanted);
  builder.connect(triggered.out, positive.in);
  builder.export_input("in", triggered.in);
  const std::vector<std::string> problems = test::problems_of([&] { builder.build(); });
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(
      problems[0],
      "algebraic loop: robot/positive/out -> robot/triggered/wanted -> robot/triggered/out -> "
      "robot/positive/in -> robot/positive/out; let one of these outputs read a state instead of an input");
}

TEST(Diagram, TellsInItsScheduleWhatIsHeld) {
  DiagramBuilder builder("robot");
  auto& counter = builder.add<test::Counter>("counter");
  auto& sampled = builder.add<Sampled>("sampled", Every{10ms});
  builder.connect(counter.count, sampled.in);
  const std::string schedule = builder.build()->schedule();
  EXPECT_NE(schedule.find("output     robot/sampled/out  every 10000000 ns  <- robot/counter/count"),
            std::string::npos)
      << schedule;
}

}  // namespace
}  // namespace flinch
