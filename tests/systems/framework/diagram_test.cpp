#include "systems/framework/diagram.h"

#include <gmock/gmock.h>

#include <thread>

#include "systems/foundation/setup_error.h"
#include "systems/framework/diagram_builder.h"
#include "systems/framework/random.h"
#include "systems/framework/recorder.h"
#include "systems/framework/runge_kutta.h"
#include "systems/framework/simulator.h"
#include "tests/support/allocations.h"
#include "tests/support/blocks.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

using test::Adder;
using test::Counter;
using test::Decay;
using test::Delay;
using test::Gain;

/// An accumulator with a gain in its loop, driven by noise: enough of everything to compare bits.
class Noise final : public System {
  State<RandomGenerator> generator_;
  State<double> value_ = state<double>("value", 0.0);

 public:
  explicit Noise(std::uint64_t seed)
      : generator_(state<RandomGenerator>("generator", RandomGenerator(seed))) {
    update<&Noise::advance>(generator_, generator_);
    update<&Noise::draw>(value_, generator_);
  }
  OutputPort<double> value = output<&Noise::read>("value", value_);

 private:
  RandomGenerator advance(RandomGenerator generator) const {
    generator();
    return generator;
  }
  double draw(RandomGenerator generator) const { return generator.normal(); }
  double read(double drawn) const { return drawn; }
};

struct Loop {
  std::unique_ptr<Diagram> diagram;
  OutputPort<double> sum;
};

/// noise -> sum -> (delay -> gain -> sum) and an integrator pushed by the delay.
Loop flat_loop() {
  DiagramBuilder builder("loop");
  auto& noise = builder.add<Noise>("noise", 7);
  auto& adder = builder.add<Adder>("adder");
  auto& delay = builder.add<Delay>("delay");
  auto& gain = builder.add<Gain>("gain", 0.5);
  auto& decay = builder.add<Decay>("decay", -30.0, 1.0);
  auto& mix = builder.add<Adder>("mix");
  builder.connect(noise.value, mix.a);
  builder.connect(decay.x, mix.b);
  builder.connect(mix.sum, adder.a);
  builder.connect(gain.out, adder.b);
  builder.connect(adder.sum, delay.in);
  builder.connect(delay.out, gain.in);
  builder.connect(delay.out, decay.push);
  const auto sum = builder.export_output("sum", adder.sum);
  return {builder.build(), sum};
}

/// The same, with delay and gain nested, the gain twice.
Loop nested_loop() {
  DiagramBuilder inner("feedback");
  auto& delay = inner.add<Delay>("delay");
  DiagramBuilder innermost("amplifier");
  auto& gain = innermost.add<Gain>("gain", 0.5);
  const auto gain_in = innermost.export_input("in", gain.in);
  const auto gain_out = innermost.export_output("out", gain.out);
  inner.add(innermost.build());
  const auto back_in = inner.export_input("in", delay.in);
  inner.connect(delay.out, gain_in);
  const auto back_out = inner.export_output("out", gain_out);
  const auto delayed = inner.export_output("delayed", delay.out);

  DiagramBuilder builder("loop");
  auto& adder = builder.add<Adder>("adder");
  builder.add(inner.build());
  auto& mix = builder.add<Adder>("mix");
  auto& decay = builder.add<Decay>("decay", -30.0, 1.0);
  auto& noise = builder.add<Noise>("noise", 7);
  builder.connect(noise.value, mix.a);
  builder.connect(decay.x, mix.b);
  builder.connect(mix.sum, adder.a);
  builder.connect(back_out, adder.b);
  builder.connect(adder.sum, back_in);
  builder.connect(delayed, decay.push);
  const auto sum = builder.export_output("sum", adder.sum);
  return {builder.build(), sum};
}

std::vector<double> run(const Loop& loop, Context context, int ticks) {
  Simulator simulator(*loop.diagram);
  std::vector<double> sums;
  for (int k = 0; k < ticks; ++k) {
    simulator.step(context);
    sums.push_back(context.get(loop.sum));
  }
  return sums;
}

// ---------------------------------------------------------------- laws

TEST(Diagram, GivesTheSameBitsNestedAndFlat) {
  const Loop flat = flat_loop();
  const Loop nested = nested_loop();
  EXPECT_EQ(run(flat, flat.diagram->make_context(), 2000), run(nested, nested.diagram->make_context(), 2000));
}

TEST(Diagram, GivesTheSameBitsInTwoThreadsThatShareIt) {
  const Loop loop = flat_loop();
  const Context start = loop.diagram->make_context();
  const std::vector<double> alone = run(loop, start, 2000);
  std::vector<double> first, second;
  std::thread one([&] { first = run(loop, start, 2000); });
  std::thread two([&] { second = run(loop, start, 2000); });
  one.join();
  two.join();
  EXPECT_EQ(first, alone);
  EXPECT_EQ(second, alone);
}

TEST(Diagram, NeverAllocatesInATick) {
  const Loop loop = nested_loop();
  Simulator simulator(*loop.diagram);
  Recorder recorder(*loop.diagram, recordable_paths(*loop.diagram), 2000);
  simulator.record(recorder);
  Context context = loop.diagram->make_context();
  simulator.step(context);
  const test::AllocationCounter counter;
  for (int k = 0; k < 1000; ++k) simulator.step(context);
  EXPECT_EQ(counter.count(), 0);
}

TEST(Context, RewindsToACopy) {
  const Loop loop = flat_loop();
  Context context = loop.diagram->make_context();
  run(loop, context, 10);
  Simulator simulator(*loop.diagram);
  simulator.advance_to(context, 100ms);
  const Context snapshot = context;
  const std::vector<double> first = run(loop, context, 500);
  simulator.advance_to(context, 300ms);
  const test::AllocationCounter counter;
  context = snapshot;
  EXPECT_EQ(counter.count(), 0);
  EXPECT_EQ(context.time(), Time(100ms));
  EXPECT_EQ(run(loop, context, 500), first);
}

// ---------------------------------------------------------------- meaning of a tick

TEST(Diagram, WritesAllDueUpdatesAtOnceFromTheOldStates) {
  // Two delays in a row: after the tick at t_k, the second holds what the first held before.
  DiagramBuilder builder;
  auto& counter = builder.add<Counter>("counter");
  auto& first = builder.add<Delay>("first");
  auto& second = builder.add<Delay>("second");
  builder.connect(counter.count, first.in);
  builder.connect(first.out, second.in);
  const auto diagram = builder.build();
  Context context = diagram->make_context();
  Simulator(*diagram).advance_to(context, 10ms);
  EXPECT_EQ(context.get(counter.count), 10.0);
  EXPECT_EQ(context.get(first.out), 9.0);
  EXPECT_EQ(context.get(second.out), 8.0);
}

/// A number that counts how often one is copied into another.
struct Copied {
  double value = 0.0;
  Copied() = default;
  Copied(const Copied&) = default;
  Copied& operator=(const Copied& other) {
    value = other.value;
    ++copies;
    return *this;
  }
  ~Copied() = default;
  static inline int copies = 0;
};

}  // namespace

template <>
inline constexpr bool never_allocates<Copied> = true;

namespace {

/// Sums up ticks in place; `shown` is what an output reads of it.
class Tally : public System {
 protected:
  State<Copied> sum_ = state<Copied>("sum");

 public:
  OutputPort<double> shown = output<&Tally::read>("shown", sum_);

 private:
  Update add_ = update<&Tally::add>(sum_, shown);
  double read(const Copied& sum) const { return sum.value; }
  void add(double before, Copied& sum) const { sum.value = before + 1.0; }
};

/// The same, with another update that reads the sum.
class WatchedTally final : public Tally {
  State<double> last_ = state<double>("last", 0.0);

 public:
  OutputPort<double> before = output<&WatchedTally::read_last>("before", last_);

 private:
  Update follow_ = update<&WatchedTally::follow>(last_, sum_);
  double follow(const Copied& sum) const { return sum.value; }
  double read_last(double last) const { return last; }
};

TEST(Diagram, CopiesNoStateThatNoUpdateReads) {
  DiagramBuilder builder;
  auto& alone = builder.add<Tally>("alone");
  const auto diagram = builder.build();
  Context context = diagram->make_context();
  Copied::copies = 0;
  Simulator(*diagram).advance_to(context, 10ms);
  EXPECT_EQ(context.get(alone.shown), 10.0);
  EXPECT_EQ(Copied::copies, 0);
}

TEST(Diagram, ShowsUpdatesTheOldValueOfAStateThatTheyRead) {
  DiagramBuilder builder;
  auto& watched = builder.add<WatchedTally>("watched");
  const auto diagram = builder.build();
  Context context = diagram->make_context();
  Simulator(*diagram).advance_to(context, 10ms);
  EXPECT_EQ(context.get(watched.shown), 10.0);
  EXPECT_EQ(context.get(watched.before), 9.0);
}

TEST(Diagram, RunsUpdatesAtTheirPeriodAndOffset) {
  DiagramBuilder builder;
  auto& counter = builder.add<Counter>("counter");
  auto& slow = builder.add<Delay>("slow", Every{4ms, 1ms});
  builder.connect(counter.count, slow.in);
  const auto diagram = builder.build();
  Context context = diagram->make_context();
  Simulator simulator(*diagram);
  std::vector<double> seen;
  for (int k = 0; k < 10; ++k) {
    simulator.step(context);
    seen.push_back(context.get(slow.out));
  }
  // Written at 1, 5 and 9 ms; seen from the tick after on.
  EXPECT_EQ(seen, (std::vector<double>{0, 0, 1, 1, 1, 1, 5, 5, 5, 5}));
}

TEST(Diagram, HoldsADiscreteStateWithoutDelayForContinuousOnes) {
  // x' = count: after the tick at t_k the counter shows k + 1, and acts from t_k on.
  DiagramBuilder builder;
  auto& counter = builder.add<Counter>("counter");
  auto& integral = builder.add<Decay>("integral", 0.0, 0.0);
  builder.connect(counter.count, integral.push);
  const auto diagram = builder.build();
  Context context = diagram->make_context();
  Simulator(*diagram).advance_to(context, 3ms);
  EXPECT_NEAR(context.get(integral.x), (1 + 2 + 3) * 1e-3, 1e-15);
}

TEST(Diagram, TakesInputsOnlyFromOutsideTheTick) {
  DiagramBuilder builder;
  auto& gain = builder.add<Gain>("gain", 3.0);
  const auto in = builder.export_input("in", gain.in);
  const auto diagram = builder.build();
  Context context = diagram->make_context();
  context.set(in, 2.0);
  diagram->evaluate(context);
  EXPECT_EQ(context.get(gain.out), 6.0);
  EXPECT_EQ(context.get(gain.in), 2.0);
  EXPECT_THROW(context.set(gain.in, 1.0), SetupError);
}

TEST(Simulator, IntegratesLikeTheClosedForm) {
  DiagramBuilder builder;
  auto& decay = builder.add<Decay>("decay", -2.0, 1.5);
  const auto push = builder.export_input("push", decay.push);
  const auto diagram = builder.build();
  Context context = diagram->make_context();
  context.set(push, 0.7);
  Simulator(*diagram, std::make_unique<RungeKutta>(4)).advance_to(context, 1s);
  const double exact = 0.35 + (1.5 - 0.35) * std::exp(-2.0);
  EXPECT_NEAR(context.get(decay.x), exact, 1e-14);
}

/// x' = -1e6 x.
class Stiff final : public System {
  State<double> x_ = state<double>("x", 1.0);

 public:
  Stiff() { require_adaptive_steps(); }

 private:
  Derivative move_ = derivative<&Stiff::rate>(x_, x_);
  double rate(double x) const { return -1e6 * x; }
};

TEST(Simulator, RefusesEqualStepsWhereABlockNeedsOthers) {
  DiagramBuilder station("station");
  station.add<Stiff>("spring");
  DiagramBuilder builder("loop");
  builder.add(station.build());
  const auto diagram = builder.build();
  EXPECT_THAT(
      test::problems_of([&] { Simulator simulator(*diagram); }),
      testing::ElementsAre(testing::HasSubstr("the motion of 'station/spring' in the diagram 'loop'")));
  EXPECT_NO_THROW(Simulator(*diagram, std::make_unique<RungeKutta>(10'000)));
}

TEST(Diagram, NamesTheNearestPortWhenATapIsUnknown) {
  const Loop loop = nested_loop();
  EXPECT_EQ(loop.diagram->tap("feedback/amplifier/gain/out").path, "feedback/amplifier/gain/out");
  try {
    loop.diagram->tap("feedback/amplifier/gain/our");
    FAIL();
  } catch (const SetupError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean 'feedback/amplifier/gain/out'?"),
              std::string::npos);
  }
}

TEST(Diagram, DrawsItself) {
  const std::string dot = nested_loop().diagram->graphviz();
  EXPECT_NE(dot.find("label=\"feedback\""), std::string::npos);
  EXPECT_NE(dot.find("<b>gain</b>"), std::string::npos);
  EXPECT_EQ(dot, nested_loop().diagram->graphviz());
}

TEST(Diagram, ListsItsScheduleInAnOrderInWhichWhatIsReadComesFirst) {
  const std::string schedule = flat_loop().diagram->schedule();
  EXPECT_LT(schedule.find("output     loop/delay/out"), schedule.find("output     loop/gain/out"));
  EXPECT_LT(schedule.find("output     loop/gain/out"), schedule.find("output     loop/adder/sum"));
  EXPECT_NE(schedule.find("derivative loop/decay/x  <- loop/decay/x, loop/delay/out"), std::string::npos)
      << schedule;
}

}  // namespace
}  // namespace flinch
