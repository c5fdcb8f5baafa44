#include "experiments/bus/opening_monitor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flinch {
namespace {

using testing::HasSubstr;

GateStatus waiting(GateFault fault) { return {.phase = GatePhase::waiting, .faults = fault_bit(fault)}; }

/// When a gate that looks like that all the time is given up; never within a minute: Time::max().
Time given_up(const GateStatus& gate) {
  OpeningMonitor watch;
  for (Time now = 0ms; now < 60s; now += 1ms)
    if (watch.sees_it_closed(gate, now)) return now;
  return Time::max();
}

TEST(OpeningMonitor, GivesUpAGateThatStaysClosedAndSaysWhy) {
  EXPECT_EQ(given_up(waiting(GateFault::station_disabled)), OpeningMonitor::longest + 1ms);
  OpeningMonitor watch;
  watch.sees_it_closed(waiting(GateFault::station_disabled), 2001ms);
  EXPECT_THAT(watch.sentence(), HasSubstr("did not open within 2 s: the station does not act on torques"));
}

TEST(OpeningMonitor, LeavesAnObserverTimeToSettleWhereNothingElseIsWrong) {
  EXPECT_EQ(given_up(waiting(GateFault::contact_unmonitored)), OpeningMonitor::until_settled + 1ms);
  GateStatus both = waiting(GateFault::contact_unmonitored);
  both.faults |= fault_bit(GateFault::joints_invalid);
  EXPECT_EQ(given_up(both), OpeningMonitor::longest + 1ms);
}

TEST(OpeningMonitor, HasNothingAgainstAGateThatWasOpenOnce) {
  EXPECT_EQ(given_up({.phase = GatePhase::open}), Time::max());
  OpeningMonitor watch;
  EXPECT_FALSE(watch.sees_it_closed({.phase = GatePhase::open}, 300ms));
  EXPECT_FALSE(
      watch.sees_it_closed({.phase = GatePhase::closed, .faults = fault_bit(GateFault::loop_late)}, 5s));
  EXPECT_TRUE(watch.has_opened());
}

}  // namespace
}  // namespace flinch
