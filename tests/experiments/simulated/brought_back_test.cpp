#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/recorded/replay.h"
#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "experiments/verdict/verdict.h"
#include "systems/framework/recorded_values.h"
#include "systems/signals/target_command.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

SimulatedScenario brought_back() {
  return read_simulated_scenario(test::shipped("scenarios/brought_back.yaml"));
}

/// The shipped scenario with something in place of something else.
SimulatedScenario changed(const std::string& from, const std::string& to) {
  const test::Workplace place;
  place.replace("scenarios/brought_back.yaml", from, to);
  return read_simulated_scenario(place / "scenarios/brought_back.yaml");
}

TEST(ARobotThatIsBroughtBack, IsInItsNominalMotionAgainAndWasSlowOnTheWay) {
  const SimulatedScenario scenario = brought_back();
  const Recording recording = run_experiment(scenario);
  const Verdict verdict =
      judge(recording, scenario.robot.robot->space(), scenario.expected, scenario.force_limits);
  EXPECT_THAT(verdict.failures, IsEmpty());
  EXPECT_THAT(verdict.remarks, Contains(HasSubstr("too far out")));
  ASSERT_TRUE(verdict.returned);
  EXPECT_EQ(verdict.returned->from, "stopped");
  EXPECT_EQ(verdict.returned->stopped_by, "the platform is too far out");
  EXPECT_EQ(verdict.returned->resets, 1);
  ASSERT_TRUE(verdict.returned->resumed);
  EXPECT_GT(verdict.returned->recovery_speed, 0.03);
  EXPECT_LT(verdict.returned->recovery_speed, 0.06);
  EXPECT_LT(verdict.returned->nominal_speed, 0.06);
  EXPECT_EQ(RecordedValues<TargetCommand>(recording, "target")[recording.samples() - 1].number, 1U);

  const Replay again = replay(scenario, recording, {}, {}, {});
  EXPECT_THAT(again.differing, IsEmpty()) << "buttons and targets are taken from the recording";
}

TEST(ARobotThatIsBroughtBack, IsNotWhereNobodyGivesATarget) {
  const Verdict verdict =
      judge_experiment(changed("  - {after: recovering, pose: {x_mm: -260, y_mm: 0}}    # left out where the "
                               "robot stands within its limits\n",
                               ""));
  EXPECT_THAT(verdict.failures, ElementsAre("the nominal motion did not begin again"));
}

TEST(ARobotThatIsBroughtBack, IsLateWhereItTakesLonger) {
  const Verdict verdict = judge_experiment(changed("return_time_s: 5 ", "return_time_s: 0.5 "));
  EXPECT_THAT(verdict.failures, ElementsAre(HasSubstr("later than 0.50 s")));
}

TEST(ARobotThatIsBroughtBack, HasBeenStoppedWhereNothingElseIsExpected) {
  const Verdict verdict =
      judge_experiment(changed("expect:\n  return_time_s: 5 ", "expect:\n  tracking_error_m: 1 "));
  EXPECT_THAT(verdict.failures,
              ElementsAre(HasSubstr("the torque gate closed: the platform is too far out")));
}

}  // namespace
}  // namespace flinch
