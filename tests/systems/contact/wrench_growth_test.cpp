#include "systems/contact/wrench_growth.h"

#include <gtest/gtest.h>

#include <limits>

#include "systems/framework/random.h"
#include "tests/support/allocations.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

struct Growth {
  Growth()
      : block(builder.add<WrenchGrowth>("growth")),
        wrench(builder.export_input("wrench", block.wrench)),
        ticking(builder) {}

  void see(const PlatformVector& estimate, bool valid = true, Time late = Time{}) {
    ticking.set(wrench, WrenchEstimate{.acquired = ticking.now() - late,
                                       .valid = valid,
                                       .wrench_in_base = estimate,
                                       .drive_torque = JointVector::Zero(3)});
    ticking.tick();
  }
  WrenchEstimate change() { return ticking.get(block.change); }
  WrenchEstimate before() { return ticking.get(block.change_before); }

  DiagramBuilder builder;
  WrenchGrowth& block;
  InputPort<WrenchEstimate> wrench;
  test::Ticking ticking;
};

PlatformVector squared(int tick) { return Eigen::Vector3d(tick * tick, -2.0 * tick * tick, 0.1 * tick); }

TEST(WrenchGrowth, IsWhatTheEstimateWasFiveAndTenTicksAgo) {
  Growth growth;
  for (int tick = 0; tick <= 30; ++tick) growth.see(squared(tick));
  ASSERT_TRUE(growth.change().valid);
  ASSERT_TRUE(growth.before().valid);
  EXPECT_EQ(growth.change().wrench_in_base, squared(30) - squared(25));
  EXPECT_EQ(growth.before().wrench_in_base, squared(25) - squared(20));
  EXPECT_EQ(growth.change().acquired, 30ms);
}

TEST(WrenchGrowth, AddsUpToTheEstimate) {
  Growth growth;
  RandomGenerator random(1);
  PlatformVector ten_ago = PlatformVector::Zero(3);
  for (int tick = 0; tick <= 40; ++tick) {
    const PlatformVector now = Eigen::Vector3d(random.normal(), random.normal(), random.normal());
    growth.see(now);
    if (tick == 30) ten_ago = now;
    if (tick != 40) continue;
    EXPECT_LT((now - growth.change().wrench_in_base - growth.before().wrench_in_base - ten_ago).norm(),
              1e-15);
  }
}

TEST(WrenchGrowth, IsUnknownUntilThereIsAPast) {
  Growth growth;
  for (int tick = 0; tick < 5; ++tick) {
    growth.see(squared(tick));
    EXPECT_FALSE(growth.change().valid) << tick;
  }
  for (int tick = 5; tick < 10; ++tick) {
    growth.see(squared(tick));
    EXPECT_TRUE(growth.change().valid) << tick;
    EXPECT_FALSE(growth.before().valid) << tick;
  }
  growth.see(squared(10));
  EXPECT_TRUE(growth.before().valid);
}

TEST(WrenchGrowth, DoesNotReachOverWhatWasNotEstimated) {
  Growth growth;
  for (int tick = 0; tick < 20; ++tick) growth.see(squared(tick));
  growth.see(Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()), false);
  EXPECT_FALSE(growth.change().valid);
  for (int tick = 21; tick < 31; ++tick) {
    growth.see(squared(tick));
    EXPECT_EQ(growth.change().valid, tick >= 26) << tick;
    EXPECT_FALSE(growth.before().valid) << tick;
  }
  growth.see(squared(31));
  EXPECT_EQ(growth.before().wrench_in_base, squared(26) - squared(21));
}

TEST(WrenchGrowth, ComparesTimesOfAcquisitionNotTicks) {
  Growth growth;
  for (int tick = 0; tick < 20; ++tick) growth.see(squared(tick));
  for (int tick = 20; tick < 23; ++tick) growth.see(squared(19), true, (tick - 19) * 1ms);  // nothing new
  EXPECT_EQ(growth.change().wrench_in_base, squared(19) - squared(14));
  growth.see(squared(23));
  EXPECT_EQ(growth.change().wrench_in_base, squared(23) - squared(18));
}

TEST(WrenchGrowth, DoesNotAllocate) {
  Growth growth;
  for (int tick = 0; tick < 20; ++tick) growth.see(squared(tick));
  const WrenchEstimate next{
      .acquired = 20ms, .valid = true, .wrench_in_base = squared(20), .drive_torque = JointVector::Zero(3)};
  growth.ticking.set(growth.wrench, next);
  const test::AllocationCounter allocations;
  growth.ticking.tick();
  EXPECT_EQ(allocations.count(), 0);
}

}  // namespace
}  // namespace flinch
