// A run that is judged while it goes on, and the same run recorded and judged afterwards.
#include <gtest/gtest.h>

#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "experiments/verdict/verdict.h"
#include "experiments/verdict/verdict_output.h"
#include "systems/framework/recording.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

class EachRun : public ::testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(AJudgedExperiment, EachRun,
                         ::testing::Values("platform_collision", "platform_collision_realistic",
                                           "platform_collision_fused", "clamping"),
                         [](const auto& each) { return std::string(each.param); });

TEST_P(EachRun, HasTheVerdictOfItsRecording) {
  const SimulatedScenario scenario =
      read_simulated_scenario(test::shipped("scenarios/" + std::string(GetParam()) + ".yaml"));
  const Verdict recorded = judge(run_experiment(scenario), scenario.robot.robot->space(), scenario.expected,
                                 scenario.force_limits);
  EXPECT_FALSE(recorded.contacts.empty());
  EXPECT_EQ(verdict_json(judge_experiment(scenario), {}), verdict_json(recorded, {}));
}

}  // namespace
}  // namespace flinch
