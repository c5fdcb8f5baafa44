// What a run on the bus says before it begins; that it runs, tests/apps/flinch/bus shows with whole programs.
#include "experiments/bus/live_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "drivers/dds_bus.h"
#include "experiments/scenario/scenario.h"
#include "systems/foundation/setup_error.h"
#include "tests/support/free_domain.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::HasSubstr;

/// Why a run of a shipped scenario did not begin.
std::string why_not(const LiveRunSettings& settings) {
  const Scenario scenario = read_scenario(test::shipped("scenarios/platform_collision.yaml"));
  const DdsBus bus({.domain = test::free_domain()});
  try {
    run_live_experiment(scenario, bus, "never_made.h5", settings);
  } catch (const SetupError& error) {
    EXPECT_FALSE(std::filesystem::exists("never_made.h5.part"));
    return error.what();
  }
  return "it ran";
}

TEST(LiveRun, SaysThatNobodyIsThere) {
  EXPECT_THAT(why_not({.patience = 100ms}), HasSubstr("nobody sends joint readings there"));
}

TEST(LiveRun, DoesNotWaitForARobotWhenSomebodyInterrupts) {
  EXPECT_THAT(why_not({.patience = 10min, .interrupts = [] { return 1; }}),
              HasSubstr("interrupted; nothing has moved"));
}

TEST(LiveRun, TellsWithItsFileWhatIsWrongWithTheScenario) {
  Scenario scenario = read_scenario(test::shipped("scenarios/square.yaml"));
  scenario.control.contact_detector.reaction.force = -1.0;
  const DdsBus bus({.domain = test::free_domain()});
  try {
    const LiveRun run(scenario, bus, {});
    ADD_FAILURE() << "it was taken";
  } catch (const SetupError& error) {
    EXPECT_THAT(error.what(), HasSubstr("square.yaml: "));
  }
}

}  // namespace
}  // namespace flinch
