// The strict reaction in closed loop, of every shipped robot by its own constraints.
#include <gtest/gtest.h>

#include <string>

#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "experiments/verdict/verdict.h"
#include "tests/experiments/simulated/scenario_of_each_robot.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

class RobotThatKeepsItsLimits : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Shipped, RobotThatKeepsItsLimits, testing::ValuesIn(test::scenario_of_each_robot),
                         [](const auto& scenario) { return std::string(scenario.param); });

TEST_P(RobotThatKeepsItsLimits, IsReleasedByTheStrictReactionOfItsScenario) {
  const SimulatedScenario scenario =
      read_simulated_scenario(test::shipped(std::string("scenarios/") + GetParam() + ".yaml"),
                              {"control.reaction_laws=[strict_reaction]"});
  const Verdict verdict = judge_experiment(scenario);
  ASSERT_FALSE(verdict.contacts.empty());
  const ContactVerdict& contact = verdict.contacts.front();
  EXPECT_TRUE(contact.removed.has_value());
  EXPECT_TRUE(contact.could_stop.value_or(false));
  EXPECT_TRUE(contact.within_limit);
  EXPECT_TRUE(verdict.self_contacts.empty());
  EXPECT_EQ(verdict.fault, "");
  ASSERT_TRUE(verdict.measures.sigma_kappa && verdict.measures.sigma_sc);
  const ConstraintSettings& constraints = scenario.control.tasks.constraints;
  EXPECT_LE(verdict.measures.sigma_kappa->most, constraints.sigma_kappa.safety);
  EXPECT_GE(verdict.measures.sigma_sc->least, constraints.sigma_sc.safety);
}

}  // namespace
}  // namespace flinch
