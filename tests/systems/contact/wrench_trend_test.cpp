#include "systems/contact/wrench_trend.h"

#include <gtest/gtest.h>

#include <cmath>

#include "systems/foundation/setup_error.h"
#include "tests/support/allocations.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

struct Block {
  Block()
      : block(builder.add<WrenchTrend>("trend", 10ms)),
        wrench(builder.export_input("wrench", block.wrench)),
        ticking(builder) {}

  WrenchEstimate see(Time acquired, const PlatformVector& seen, bool valid = true) {
    WrenchEstimate estimate;
    estimate.acquired = acquired;
    estimate.valid = valid;
    estimate.wrench_in_base = seen;
    ticking.set(wrench, estimate);
    ticking.tick();
    return ticking.get(block.change);
  }

  DiagramBuilder builder;
  WrenchTrend& block;
  InputPort<WrenchEstimate> wrench;
  test::Ticking ticking;
};

const PlatformVector one{{3.0, -4.0, 0.5}};

TEST(WrenchTrend, TellsOfARampWhatAFilterWithItsTimeConstantIsBehindBy) {
  Block trend;
  const test::AllocationCounter allocations;
  WrenchEstimate change;
  for (int tick = 0; tick < 400; ++tick) change = trend.see(tick * 1ms, 1e-3 * tick * one);
  ASSERT_TRUE(change.valid);
  const double behind = 1e-3 / -std::expm1(-0.1);  // 10.5 ms of it, in steps of one
  EXPECT_LT((change.wrench_in_base - behind * one).norm(), 1e-12);
  EXPECT_EQ(allocations.count(), 0);
}

TEST(WrenchTrend, IsTheSameForStampsThatJitter) {
  Block even, uneven;
  WrenchEstimate of_even, of_uneven;
  for (int tick = 0; tick < 300; ++tick) {
    const Time late = tick % 3 == 1 ? 100us : 0us;
    of_even = even.see(tick * 1ms, 1e-3 * tick * one);
    of_uneven = uneven.see(tick * 1ms + late, (1e-3 * tick + to_seconds(late)) * one);
  }
  EXPECT_LT((of_even.wrench_in_base - of_uneven.wrench_in_base).norm(), 0.02 * of_even.wrench_in_base.norm());
}

TEST(WrenchTrend, ForgetsAStepAndKnowsNothingAfterAGap) {
  Block trend;
  EXPECT_FALSE(trend.see(0ms, one).valid) << "nothing came before";
  EXPECT_LT(trend.see(1ms, one).wrench_in_base.norm(), 1e-15);
  EXPECT_LT((trend.see(2ms, 2.0 * one).wrench_in_base - one).norm(), 1e-12);
  for (int tick = 3; tick < 203; ++tick) trend.see(tick * 1ms, 2.0 * one);
  EXPECT_LT(trend.see(203ms, 2.0 * one).wrench_in_base.norm(), 1e-7);
  EXPECT_FALSE(trend.see(204ms, one, false).valid);
  EXPECT_FALSE(trend.see(205ms, one).valid);
}

TEST(WrenchTrend, AsksForATimeConstant) { EXPECT_THROW(WrenchTrend(0ms), SetupError); }

}  // namespace
}  // namespace flinch
