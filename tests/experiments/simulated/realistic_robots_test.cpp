// A slice of tests/campaign/realism, which tries fifty robots.
#include "tests/experiments/simulated/realistic_robots.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>

#include "experiments/simulated/experiment.h"
#include "experiments/verdict/verdict.h"
#include "systems/framework/recording.h"
#include "systems/robot/parallel_robot.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using test::FreeMotion;
using test::FreeMotionErrors;
using test::RobotTrial;

TEST(RealisticRobots, MoveWithoutAFaultAndWithoutAContactThatIsNone) {
  std::printf("%s", test::table_head().c_str());
  for (const FreeMotion motion : {FreeMotion::square, FreeMotion::point_to_point}) {
    const RobotTrial trial{.motion = motion};
    const FreeMotionErrors errors = test::try_robots(trial, 4, 1001);
    std::printf("%s", test::table_row(trial, errors).c_str());
    EXPECT_THAT(errors.faults, ::testing::IsEmpty());
    EXPECT_EQ(errors.crossings, 0);
    EXPECT_EQ(errors.alarmed_robots, 0);
    EXPECT_LT(errors.largest_force, 10.0);
    EXPECT_GT(errors.seconds, 4 * 3.0);
  }
}

TEST(RealisticRobots, AreSeenWorseThanTheirModel) {
  RobotTrial trial{.motion = FreeMotion::point_to_point};
  const FreeMotionErrors realistic = test::try_robots(trial, 2, 1001);
  trial.realistic = false;
  const FreeMotionErrors ideal = test::try_robots(trial, 2, 1001);
  EXPECT_GT(realistic.largest_force, 1.5 * ideal.largest_force);
}

TEST(RealisticRobots, NoticeACollisionAsTheirModelDoes) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto file = test::shipped("scenarios/platform_collision_realistic.yaml");
    const SimulatedScenario scenario = read_simulated_scenario(file, seed);
    const Verdict verdict = judge(run_experiment(scenario), scenario.robot.robot->space(), scenario.expected,
                                  scenario.force_limits);
    ASSERT_EQ(verdict.contacts.size(), 1U) << "robot " << seed;
    const ContactVerdict& contact = verdict.contacts.front();
    ASSERT_TRUE(verdict.good()) << "robot " << seed << ": " << verdict.failures.front();
    std::printf("  robot %2d: noticed after %4.1f ms, %3.0f N\n", static_cast<int>(seed),
                1e3 * (*contact.detected - contact.onset), contact.peak_force);
  }
}

}  // namespace
}  // namespace flinch
