// States that keep a port, and intermediate results.
#include <gtest/gtest.h>

#include <array>

#include "systems/framework/diagram_builder.h"
#include "systems/framework/random.h"
#include "systems/framework/recorder.h"
#include "systems/framework/simulator.h"
#include "tests/support/allocations.h"
#include "tests/support/blocks.h"

namespace flinch {
namespace {

/// A value that is too large to copy for nothing, and counts how often it is copied all the same.
struct Large {
  static inline int copies = 0;

  std::array<double, 300> numbers{};

  Large() = default;
  ~Large() = default;
  Large(const Large& other) : numbers(other.numbers) { ++copies; }
  Large& operator=(const Large& other) {
    numbers = other.numbers;
    ++copies;
    return *this;
  }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("numbers", "", self.numbers);
  }
};

}  // namespace

template <>
inline constexpr bool never_allocates<Large> = true;

namespace {

/// Shifts its memory by one place and puts what it reads in front; `Keeps` says how the state comes by it.
template <bool keeps>
class Shift final : public System {
  State<Large> last_ = System::state<Large>("last");

 public:
  explicit Shift(Every every = Every{1ms}) {
    if constexpr (keeps) {
      System::keep(every, last_, shifted_);
    } else {
      System::update<&Shift::copy>(every, last_, shifted_);
    }
  }
  InputPort<double> in = System::input<double>("in");

 private:
  Intermediate<Large> shifted_ = System::intermediate<&Shift::shift>("shifted", last_, in);

 public:
  OutputPort<double> sum = System::output<&Shift::add>("sum", shifted_, last_);

 private:
  void shift(const Large& last, double first, Large& shifted) const {
    shifted.numbers.front() = first;
    std::copy(last.numbers.begin(), last.numbers.end() - 1, shifted.numbers.begin() + 1);
  }
  double add(const Large& shifted, const Large& last) const {
    double total = 0.0;
    for (std::size_t i = 0; i < last.numbers.size(); ++i)
      total = 0.9 * total + shifted.numbers[i] - 0.5 * last.numbers[i];
    return total;
  }
  void copy(const Large& shifted, Large& last) const { last = shifted; }
};

/// As test::Delay, with an identity function and so with copies.
class CopyingDelay final : public System {
  State<double> held_ = state<double>("held", 0.0);

 public:
  explicit CopyingDelay(Every every) { update<&CopyingDelay::copy>(every, held_, in); }
  InputPort<double> in = input<double>("in");
  OutputPort<double> out = output<&CopyingDelay::read>("out", held_);

 private:
  double read(double held) const { return held; }
  double copy(double value) const { return value; }
};

/// A random tick's worth of everything that can be kept: an intermediate result, an output of another block
/// (by two states, at different times), an input of the diagram; all in a loop, and pushing a continuous
/// state.
template <bool keeps>
struct Loop {
  using Memory = std::conditional_t<keeps, test::Delay, CopyingDelay>;
  std::unique_ptr<Diagram> diagram;
  InputPort<double> in;
  std::vector<OutputPort<double>> seen;

  Loop() {
    DiagramBuilder builder("loop");
    auto& outside = builder.add<Memory>("outside", Every{3ms});
    auto& shift = builder.add<Shift<keeps>>("shift");
    auto& slow_shift = builder.add<Shift<keeps>>("slow_shift", Every{4ms, 1ms});
    auto& often = builder.add<Memory>("often", Every{1ms});
    auto& seldom = builder.add<Memory>("seldom", Every{5ms, 2ms});
    auto& sum = builder.add<test::Adder>("sum");
    auto& decay = builder.add<test::Decay>("decay", -30.0, 1.0);
    auto& mix = builder.add<test::Adder>("mix");
    in = builder.export_input("in", outside.in);
    builder.connect(outside.out, sum.a);
    builder.connect(often.out, sum.b);
    builder.connect(sum.sum, shift.in);
    builder.connect(shift.sum, slow_shift.in);
    builder.connect(slow_shift.sum, decay.push);
    builder.connect(decay.x, mix.a);
    builder.connect(seldom.out, mix.b);
    builder.connect(mix.sum, often.in);
    builder.connect(mix.sum, seldom.in);
    seen = {outside.out, shift.sum, slow_shift.sum, often.out, seldom.out, sum.sum, mix.sum, decay.x};
    diagram = builder.build();
  }

  /// All that is seen after each of `ticks` ticks; in between it is evaluated once more than needed, and
  /// rewound.
  std::vector<double> run(int ticks) const {
    std::vector<double> values;
    RandomGenerator random(11);
    Simulator simulator(*diagram);
    Context context = diagram->make_context();
    for (int k = 0; k < ticks; ++k) {
      context.set(in, random.normal());
      if (k % 7 == 0) diagram->evaluate(context);
      const Context before = context;
      simulator.step(context);
      if (k % 5 == 0) {
        context = before;
        simulator.step(context);
      }
      for (const OutputPort<double>& port : seen) values.push_back(context.get(port));
    }
    return values;
  }
};

// ---------------------------------------------------------------- laws

TEST(Keep, GivesTheSameBitsAsAnUpdateThatCopies) {
  EXPECT_EQ(Loop<true>().run(1000), Loop<false>().run(1000));
}

TEST(Keep, CopiesNoOutput) {
  const Loop<true> loop;
  Simulator simulator(*loop.diagram);
  Context context = loop.diagram->make_context();
  Large::copies = 0;
  const test::AllocationCounter allocations;
  for (int k = 0; k < 100; ++k) simulator.step(context);
  EXPECT_EQ(allocations.count(), 0);
  EXPECT_EQ(Large::copies, 0);
}

// ---------------------------------------------------------------- what is where, and when

/// count = last + 1, kept.
class Steps final : public System {
 public:
  State<double> last = state<double>("last", 5.0);
  OutputPort<double> count = output<&Steps::add_one>("count", last);

 private:
  Update keep_ = keep(last, count);
  double add_one(double before) const { return before + 1.0; }
};

TEST(Keep, ShowsTheOutputOfThisTickAndTheStateBeforeAndAfterIt) {
  DiagramBuilder builder;
  auto& steps = builder.add<Steps>("steps");
  const auto diagram = builder.build();
  Context context = diagram->make_context();
  for (int again = 0; again < 3; ++again) {
    diagram->evaluate(context);
    EXPECT_EQ(context.get(steps.last), 5.0);
    EXPECT_EQ(context.get(steps.count), 6.0);
  }
  diagram->update(context);
  EXPECT_EQ(context.get(steps.last), 6.0);
  EXPECT_EQ(context.get(steps.count), 6.0);
  diagram->evaluate(context);
  EXPECT_EQ(context.get(steps.last), 6.0);
  EXPECT_EQ(context.get(steps.count), 7.0);
}

TEST(Keep, LetsAStateBeOverwrittenWithoutTheOutputThatItHasKept) {
  DiagramBuilder builder;
  auto& steps = builder.add<Steps>("steps");
  const auto diagram = builder.build();
  Context context = diagram->make_context();
  Simulator simulator(*diagram);
  simulator.step(context);
  context.set(steps.last, 100.0);
  EXPECT_EQ(context.get(steps.last), 100.0);
  EXPECT_EQ(context.get(steps.count), 6.0);
  simulator.step(context);
  EXPECT_EQ(context.get(steps.count), 101.0);
}

TEST(Keep, LetsSlotsAndRecordersFollowWhatChangesItsPlace) {
  DiagramBuilder builder;
  auto& steps = builder.add<Steps>("steps");
  const auto diagram = builder.build();
  Recorder recorder(*diagram, {"steps/count"}, 5);
  Simulator simulator(*diagram);
  simulator.record(recorder);
  Context context = diagram->make_context();
  const auto slot = diagram->slot(steps.count);
  for (double expected = 6.0; expected <= 10.0; ++expected) {
    simulator.step(context);
    EXPECT_EQ(context[slot], expected);
  }
  EXPECT_EQ(recorder.recording().column("steps/count", "value"), (std::vector<double>{6, 7, 8, 9, 10}));
}

// ---------------------------------------------------------------- intermediate results

TEST(Intermediate, IsATapThatSaysSoAndIsRecordedOnlyWhereItIsNamed) {
  const Loop<true> loop;
  EXPECT_TRUE(loop.diagram->tap("shift/shifted").intermediate);
  EXPECT_FALSE(loop.diagram->tap("shift/sum").intermediate);
  for (const std::string& path : recordable_paths(*loop.diagram)) EXPECT_NE(path, "shift/shifted");

  Recorder recorder(*loop.diagram, {"shift/shifted"}, 1);
  Simulator simulator(*loop.diagram);
  simulator.record(recorder);
  Context context = loop.diagram->make_context();
  simulator.step(context);
  EXPECT_EQ(recorder.samples(), 1U);
}

TEST(Intermediate, IsNotDrawn) {
  const std::string dot = Loop<true>().diagram->graphviz();
  EXPECT_EQ(dot.find("shifted"), std::string::npos);
  EXPECT_NE(dot.find("port=\"o1\" align=\"right\">sum"), std::string::npos) << dot;
}

TEST(Intermediate, StandsInTheScheduleWithWhatKeepsIt) {
  const std::string schedule = Loop<true>().diagram->schedule();
  EXPECT_NE(schedule.find("output     loop/shift/shifted  <- loop/shift/last"), std::string::npos)
      << schedule;
  EXPECT_NE(schedule.find("keep       loop/shift/last  <- loop/shift/shifted"), std::string::npos)
      << schedule;
}

}  // namespace
}  // namespace flinch
