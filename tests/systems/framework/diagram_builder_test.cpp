// What is wired, and what build() finds.
#include "systems/framework/diagram_builder.h"

#include <gtest/gtest.h>

#include "systems/foundation/setup_error.h"
#include "systems/framework/simulator.h"
#include "tests/support/blocks.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

using test::Adder;
using test::Counter;
using test::Delay;
using test::Gain;

TEST(DiagramBuilder, ConnectsOneOutputWithSeveralInputs) {
  DiagramBuilder builder;
  auto& counter = builder.add<Counter>("counter");
  auto& sum = builder.add<Adder>("sum");
  auto& gain = builder.add<Gain>("gain", 3.0);
  builder.connect(counter.count, sum.a, sum.b, gain.in);
  const auto diagram = builder.build();
  Context context = diagram->make_context();
  Simulator(*diagram).advance_to(context, 5ms);
  EXPECT_EQ(context.get(sum.sum), 10.0);
  EXPECT_EQ(context.get(gain.out), 15.0);
}

TEST(DiagramBuilder, FixesInputsToAValue) {
  DiagramBuilder builder;
  auto& sum = builder.add<Adder>("sum");
  auto& gain = builder.add<Gain>("gain", 3.0);
  builder.fix(2.5, sum.a, sum.b, gain.in);
  const auto diagram = builder.build();
  Context context = diagram->make_context();
  diagram->evaluate(context);
  EXPECT_EQ(context.get(sum.sum), 5.0);
  EXPECT_EQ(context.get(gain.out), 7.5);
  EXPECT_EQ(diagram->children().back()->name(), "sum_a");
}

TEST(DiagramBuilder, ReportsAllWiringErrorsAtOnceWithFullPaths) {
  DiagramBuilder builder("robot");
  auto& one = builder.add<Adder>("sum");
  auto& two = builder.add<Adder>("sum");
  auto& fast = builder.add<Delay>("fast", Every{1500us});
  auto& late = builder.add<Delay>("late", Every{2ms, 300us});
  builder.connect(one.sum, two.a);
  builder.connect(two.sum, one.a);
  builder.connect(one.sum, fast.in);
  builder.connect(two.sum, fast.in);
  builder.connect(one.sum, late.in);
  const std::vector<std::string> expected = {
      "robot/fast/in is connected twice: to robot/sum/sum and to robot/sum/sum",
      "robot/sum: two blocks have this name",
      "robot/sum/b is not connected",
      "robot/sum/b is not connected",
      "algebraic loop: robot/sum/sum -> robot/sum/a -> robot/sum/sum -> robot/sum/a -> robot/sum/sum; let "
      "one of these "
      "outputs read a state instead of an input",
      "the update of robot/fast/held has the period 1500000 ns, which is no multiple of the tick, 1000000 ns",
      "the update of robot/late/held has the offset 300000 ns, which is no multiple of the tick, 1000000 ns"};
  EXPECT_EQ(test::problems_of([&] { builder.build(); }), expected);
}

TEST(DiagramBuilder, FeedsAnOptionalInputThatNobodyConnects) {
  for (const bool fed : {false, true}) {
    DiagramBuilder inner("inner");
    auto& gain = inner.add<Gain>("gain", 2.0);
    const auto in = inner.optional_input<double>("in");
    inner.connect(in, gain.in);
    const auto out = inner.export_output("out", gain.out);
    DiagramBuilder middle("middle");
    middle.add(inner.build());
    const auto shown = middle.export_output("out", out);
    const auto own = middle.optional_input<double>("in");
    middle.connect(own, in);
    DiagramBuilder outer("outer");
    auto& counter = outer.add<Counter>("counter");
    outer.add(middle.build());
    if (fed) outer.connect(counter.count, own);
    const auto diagram = outer.build();
    Context context = diagram->make_context();
    Simulator(*diagram).advance_to(context, 3ms);
    EXPECT_EQ(context.get(shown), fed ? 2.0 * context.get(counter.count) : 0.0);
    EXPECT_EQ(diagram->children().size(), fed ? 2U : 3U);
  }
}

TEST(DiagramBuilder, ListsALoopThroughNestedDiagramsPortByPort) {
  DiagramBuilder inner("inner");
  auto& gain = inner.add<Gain>("gain", 2.0);
  const auto in = inner.export_input("in", gain.in);
  const auto out = inner.export_output("out", gain.out);
  DiagramBuilder builder("outer");
  builder.add(inner.build());
  auto& adder = builder.add<Adder>("adder");
  auto& counter = builder.add<Counter>("counter");
  auto& after = builder.add<Gain>("after", 1.0);
  builder.connect(out, adder.a);
  builder.connect(counter.count, adder.b);
  builder.connect(adder.sum, in);
  builder.connect(adder.sum, after.in);
  const std::vector<std::string> problems = test::problems_of([&] { builder.build(); });
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(
      problems[0],
      "algebraic loop: outer/adder/sum -> outer/inner/gain/in -> outer/inner/gain/out -> outer/adder/a -> "
      "outer/adder/sum; let one of these outputs read a state instead of an input");
}

TEST(DiagramBuilder, ReportsTwoSeparateLoopsOnce) {
  DiagramBuilder builder("two");
  for (const std::string name : {"a", "b"}) {
    auto& forth = builder.add<Gain>(name + "1", 1.0);
    auto& back = builder.add<Gain>(name + "2", 1.0);
    builder.connect(forth.out, back.in);
    builder.connect(back.out, forth.in);
  }
  EXPECT_EQ(test::problems_of([&] { builder.build(); }).size(), 2U);
}

TEST(DiagramBuilder, RefusesToWireIntoANestedDiagram) {
  DiagramBuilder inner("inner");
  auto& gain = inner.add<Gain>("gain", 2.0);
  inner.export_input("in", gain.in);
  DiagramBuilder builder("outer");
  builder.add(inner.build());
  auto& counter = builder.add<Counter>("counter");
  builder.connect(counter.count, gain.in);
  const std::vector<std::string> problems = test::problems_of([&] { builder.build(); });
  ASSERT_EQ(problems.size(), 2U);
  EXPECT_NE(problems[0].find("which is not in 'outer'"), std::string::npos) << problems[0];
  EXPECT_EQ(problems[1], "outer/inner/in is not connected");
}

}  // namespace
}  // namespace flinch
