// Runs on the bus in lockstep beside four busy loops: each is the run in simulation, bit for bit. Three;
// FLINCH_LOCKSTEP_RUNS in the environment says how many instead.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include "systems/framework/monotonic_clock.h"
#include "tests/apps/flinch/bus/lockstep_rig.h"
#include "tests/support/busy_loops.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

TEST(LockstepCampaign, IsTheRunInSimulationEveryTimeBesideBusyLoops) {
  const test::LockstepRig lockstep("platform_collision");
  const test::BusyLoops beside(4);
  const int runs = test::wanted("FLINCH_LOCKSTEP_RUNS", 3);
  int same = 0;
  for (int run = 0; run < runs; ++run) {
    const Time begin = MonotonicClock::now();
    const std::string difference = lockstep.difference("live" + std::to_string(run));
    EXPECT_EQ(difference, "") << "run " << run;
    if (difference.empty()) ++same;
    fmt::print("run {}: {} in {:.1f} s\n", run, difference.empty() ? "the same" : difference,
               to_seconds(MonotonicClock::now() - begin));
  }
  fmt::print("in lockstep beside four busy loops: {} of {} runs the same bit for bit\n", same, runs);
}

}  // namespace
}  // namespace flinch
