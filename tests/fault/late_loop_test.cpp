// A control loop whose ticks the machine does not start in time.
#include <gtest/gtest.h>

#include "systems/framework/realtime_runner.h"
#include "tests/fault/guarded_rig.h"
#include "tests/systems/framework/realtime_station.h"

namespace flinch {
namespace {

/// Runs 700 ticks, the one at 500 ms as late as told, and shows what the gate says then.
struct LateTick {
  explicit LateTick(Time lateness) {
    test::GuardedRig rig(test::passing_at(0.3));
    test::FakeClockTicks clock;
    test::Calls exchange;
    exchange.before = [&](Context& context) {
      clock.wake_delay = context.time() == 499ms ? lateness : Time::zero();
    };
    exchange.after = [&](const Context& context) {
      if (context.time() == 499ms) before = rig.gate();
      if (context.time() == 500ms) then = rig.gate();
      if (context.time() == 500ms) torque = rig.torque().valid;
    };
    RealtimeRunner runner(rig.diagram(), clock, exchange, std::make_unique<SundialsIntegrator>());
    runner.feed_timing(rig.timing());
    runner.run(rig.context(), 700ms);
    later = rig.gate();
  }

  GateStatus before, then, later;
  bool torque = false;
};

TEST(LateLoop, ClosesTheBrakesInTheTickThatIsTooLate) {
  const LateTick run(Time(2ms) + Time(1));
  EXPECT_EQ(run.before.phase, GatePhase::open);
  EXPECT_EQ(run.then.fault, GateFault::loop_late);
  EXPECT_EQ(run.then.reaction, GateReaction::zero_torque_and_brake);
  EXPECT_FALSE(run.torque);
  EXPECT_EQ(run.later.phase, GatePhase::closed) << "until somebody resets";
}

TEST(LateLoop, GoesOnWithinTheLimit) {
  const LateTick run(2ms);
  EXPECT_EQ(run.then.phase, GatePhase::open);
  EXPECT_EQ(run.later.phase, GatePhase::open);
}

TEST(LateLoop, DoesNotExistInSimulatedTime) {
  test::GuardedRig rig(test::passing_at(0.3));
  rig.run_until(700ms);
  EXPECT_EQ(rig.gate().phase, GatePhase::open);
}

}  // namespace
}  // namespace flinch
