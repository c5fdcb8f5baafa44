// Programs of which one hangs before anything moves.
#include <gtest/gtest.h>

#include "systems/framework/monotonic_clock.h"
#include "tests/fault/link/bus_tap.h"
#include "tests/fault/link/link_trial.h"

namespace flinch {
namespace {

using test::LinkTrial;

/// Lets the commander hang for a moment as soon as it has asked for the drives; whether the robot moves then.
bool moves_after_a_hang() {
  LinkTrial trial;
  trial.start_robot();
  trial.start_commander();
  const auto& requests = trial.at_robot().requests;
  if (!test::wait_until(10s, [&] { return requests.count > 0; })) return false;
  trial.commander().stop();
  MonotonicClock::sleep_until(MonotonicClock::now() + 100ms);
  trial.commander().resume();
  return trial.wait_for_motion();
}

TEST(ACommanderThatHungWhileTheDrivesWereSwitchedOn, AsksForThemAgain) {
  bool moved = false;
  // It may have hung when the robot moved already, which then stops for good.
  for (int attempt = 0; attempt < 4 && !moved; ++attempt) moved = moves_after_a_hang();
  EXPECT_TRUE(moved);
}

}  // namespace
}  // namespace flinch
