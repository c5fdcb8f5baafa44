#include "systems/framework/block_profile.h"

#include <gtest/gtest.h>

#include "systems/framework/diagram_builder.h"
#include "systems/framework/simulator.h"
#include "tests/support/allocations.h"
#include "tests/support/blocks.h"

namespace flinch {
namespace {

/// Moves only as the blocks of this test say.
Time fake_now{};

/// Takes 10 us for its output, and 5 us for its update, at the fourth tick 100 us.
class Slow final : public System {
  State<int> ticks_ = state<int>("ticks", 0);

 public:
  OutputPort<int> ticks = output<&Slow::show>("ticks", ticks_);

 private:
  Update count_ = update<&Slow::count>(ticks_, ticks_);
  int show(int counted) const {
    fake_now += 10us;
    return counted;
  }
  int count(int counted) const {
    fake_now += counted == 3 ? 100us : 5us;
    return counted + 1;
  }
};

std::unique_ptr<Diagram> slow_diagram() {
  DiagramBuilder inner("inner");
  inner.add<Slow>("slow");
  DiagramBuilder builder;
  auto& counter = builder.add<test::Counter>("counter");
  auto& decay = builder.add<test::Decay>("decay", -1.0, 1.0);
  builder.connect(counter.count, decay.push);
  builder.add(inner.build());
  return builder.build();
}

TEST(BlockProfile, TellsTheWorstTickOfEachBlock) {
  const auto diagram = slow_diagram();
  BlockProfile profile(*diagram, [] { return fake_now; });
  Simulator simulator(*diagram);
  simulator.profile(profile);
  Context context = diagram->make_context();
  for (int k = 0; k < 10; ++k) simulator.step(context);

  const std::vector<BlockProfile::Row> rows = profile.rows();
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(profile.ticks(), 10);
  EXPECT_EQ(rows[0].path, "inner/slow");
  EXPECT_EQ(rows[0].worst, Time(110us));
  EXPECT_EQ(rows[0].total, Time(10 * 10us + 9 * 5us + 100us));
  EXPECT_EQ(rows[1].worst, Time(0));
  EXPECT_EQ(rows[2].worst, Time(0));
}

TEST(BlockProfile, ChangesNoBitOfTheRun) {
  const auto diagram = slow_diagram();
  BlockProfile profile(*diagram);
  Simulator plain(*diagram), profiled(*diagram);
  profiled.profile(profile);
  Context one = diagram->make_context(), other = diagram->make_context();
  const Diagram::Tap x = diagram->tap("decay/x");
  for (int k = 0; k < 100; ++k) {
    plain.step(one);
    profiled.step(other);
    ASSERT_EQ(one[Slot<double>{x.place}], other[Slot<double>{x.place}]);
  }
}

TEST(BlockProfile, NeverAllocatesInATick) {
  const auto diagram = slow_diagram();
  BlockProfile profile(*diagram);
  Simulator simulator(*diagram);
  simulator.profile(profile);
  Context context = diagram->make_context();
  const test::AllocationCounter counter;
  for (int k = 0; k < 100; ++k) simulator.step(context);
  EXPECT_EQ(counter.count(), 0);
}

}  // namespace
}  // namespace flinch
