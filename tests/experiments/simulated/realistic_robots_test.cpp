// A slice of tests/campaign/realism, which tries fifty robots.
#include "tests/experiments/simulated/realistic_robots.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

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

// Straight lines at 12 m/s^2; thresholds that no estimate reaches, for a hexapod's screws rub more than 10 N.
SimulatedScenario general_scenario(const std::string& robot, const std::string& poses, std::uint64_t seed) {
  const std::filesystem::path file = test::shipped("scenarios/general.yaml");
  return parse_simulated_scenario(
      "robot: ../robots/" + robot + ".yaml\nduration_s: 1.5\nplant: {realism: bench}\n" +
          "motion: {kind: through, start_ms: 300, poses: [" + poses +
          "], limits: {velocity_m_per_s: 1.5}}\n" +
          "control: {contact_detector: {reaction_force_N: 1000, reaction_moment_Nm: 100, hard_force_N: 1000, "
          "hard_moment_Nm: 100}}\n",
      file, seed);
}

TEST(RealisticRobots, OfOtherKindsMoveWithoutAFaultEither) {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    for (const SimulatedScenario& scenario :
         {general_scenario("five_bar",
                           "{x_mm: 0, y_mm: 330}, {x_mm: 80, y_mm: 360}, {x_mm: -80, y_mm: 300}, "
                           "{x_mm: 60, y_mm: 280}",
                           seed),
          general_scenario("hexapod_6ups",
                           "{x_mm: 0, y_mm: 0, z_mm: 620}, {x_mm: 80, y_mm: 30, z_mm: 640, "
                           "rotation_deg: [5, 0, 5]}, {x_mm: -80, y_mm: -40, z_mm: 600}",
                           seed)}) {
      const Verdict verdict = judge(run_experiment(scenario), scenario.robot.robot->space(),
                                    scenario.expected, scenario.force_limits);
      std::printf("  %s %d: %5.2f N, tracking %5.2f mm\n", scenario.robot.robot->name().c_str(),
                  static_cast<int>(seed), verdict.max_observer_error_force, 1e3 * verdict.max_tracking_error);
      EXPECT_EQ(verdict.fault, "");
      EXPECT_GT(verdict.max_observer_error_force, 0.1);
      EXPECT_LT(verdict.max_tracking_error, 0.025);
    }
  }
}

// Gains that are right for one robot would let another lag by centimetres, or its torques chatter.
TEST(RealisticRobots, OfAllKindsFollowTheirMotionOnTheVelocityLevel) {
  for (const char* const name : {"platform_collision", "five_bar_collision", "hexapod_collision"}) {
    const SimulatedScenario scenario =
        read_simulated_scenario(test::shipped("scenarios/" + std::string(name) + ".yaml"),
                                {"control.nominal_laws=[velocity_tracking]"});
    const Recording recording = run_experiment(scenario);
    const Verdict verdict =
        judge(recording, scenario.robot.robot->space(), scenario.expected, scenario.force_limits);
    const std::vector<double> torque = recording.column("torque_command", "torque");
    const double largest = scenario.robot.drives.max_torque;
    double step = 0.0;  // while it stands with open brakes
    for (std::size_t k = 260; k < 298; ++k) step = std::max(step, std::abs(torque[k] - torque[k - 1]));
    std::printf("  %s: tracking %.2f mm, torque at rest steps by %.2g of the largest\n", name,
                1e3 * verdict.max_tracking_error, step / largest);
    EXPECT_EQ(verdict.fault, "");
    EXPECT_LT(verdict.max_tracking_error, 6e-3) << name;
    EXPECT_LT(step, 0.01 * largest) << name;
  }
}

class ACollision : public ::testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(RealisticRobots, ACollision,
                         ::testing::Values("platform_collision_realistic", "platform_collision_fused",
                                           "first_link_collision", "second_link_collision", "clamping",
                                           "five_bar_collision", "hexapod_collision_realistic"),
                         [](const auto& each) { return std::string(each.param); });

TEST_P(ACollision, IsAnsweredByEachAsItsScenarioExpects) {
  std::vector<double> times, forces;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto file = test::shipped("scenarios/" + std::string(GetParam()) + ".yaml");
    const SimulatedScenario scenario = read_simulated_scenario(file, {"plant.realism=bench"}, seed);
    const Verdict verdict = judge(run_experiment(scenario), scenario.robot.robot->space(), scenario.expected,
                                  scenario.force_limits);
    ASSERT_EQ(verdict.contacts.size(), 1U) << "robot " << seed;
    const ContactVerdict& contact = verdict.contacts.front();
    ASSERT_TRUE(verdict.good()) << "robot " << seed << ": " << verdict.failures.front();
    const double time = 1e3 * (*contact.detected - contact.onset);
    std::printf("  robot %2d: detected after %4.1f ms, %3.0f N\n", static_cast<int>(seed), time,
                contact.peak_force);
    times.push_back(time);
    forces.push_back(contact.peak_force);
  }
  const auto [soonest, latest] = std::minmax_element(times.begin(), times.end());
  const auto [softest, hardest] = std::minmax_element(forces.begin(), forces.end());
  std::printf("%s: %.1f to %.1f ms, %.0f to %.0f N\n", GetParam(), *soonest, *latest, *softest, *hardest);
}

}  // namespace
}  // namespace flinch
