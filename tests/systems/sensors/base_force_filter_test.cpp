#include "systems/sensors/base_force_filter.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/allocations.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

struct Block {
  Block()
      : block(builder.add<BaseForceFilter>("filter", LowPassSettings(), Sampling())),
        measured(builder.export_input("measured", block.measured)),
        status(builder.export_input("status", block.status)),
        ticking(builder) {}

  BaseForceReading see(const BaseForces& force, bool valid = true, bool braked = false) {
    BaseForceReading reading;
    reading.acquired = ticking.now();
    reading.valid = valid;
    reading.force_in_base = force;
    ticking.set(measured, reading);
    ticking.set(status, {.acquired = ticking.now(), .valid = true, .enabled = !braked, .braked = braked});
    ticking.tick();
    return ticking.get(block.filtered);
  }

  DiagramBuilder builder{"test", 1ms};
  BaseForceFilter& block;
  InputPort<BaseForceReading> measured;
  InputPort<StationStatus> status;
  test::Ticking ticking;
};

const BaseForces step = BaseForces::Constant(6, 10.0);

TEST(BaseForceFilter, LagsAsAnAlignedTorqueDoes) {
  Block filter;
  const FirstOrderLowPass low_pass{LowPassSettings()};
  LowPassMemory expected;
  const test::AllocationCounter allocations;
  for (int k = 0; k < 60; ++k) {
    const BaseForces force = k < 20 ? BaseForces(0.0 * step) : step;
    expected = low_pass.next(expected, force, 1e-3);
    const BaseForceReading reading = filter.see(force);
    ASSERT_TRUE(reading.valid);
    EXPECT_LT((reading.force_in_base - expected.output).norm(), 1e-12);
  }
  EXPECT_EQ(allocations.count(), 0);
}

TEST(BaseForceFilter, BeginsAnewUnderBrakesAndAfterAGap) {
  Block filter;
  for (int k = 0; k < 20; ++k) filter.see(0.0 * step);
  EXPECT_EQ(filter.see(step, true, true).force_in_base, step) << "brakes are closed";
  EXPECT_EQ(filter.see(step).force_in_base, step) << "in steady state from the first sample on";
  for (int k = 0; k < 20; ++k) filter.see(0.0 * step);
  for (int k = 0; k < 5; ++k) EXPECT_FALSE(filter.see(step, false).valid);
  EXPECT_EQ(filter.see(step).force_in_base, step) << "a gap";
}

TEST(BaseForceFilter, LetsNothingThroughThatIsNoNumber) {
  Block filter;
  filter.see(step);
  BaseForces broken = step;
  broken[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(filter.see(broken).valid);
  EXPECT_EQ(filter.see(step).force_in_base, step);
}

}  // namespace
}  // namespace flinch
