// Drives that are tried before the first motion, in closed loop: of realistic robots of every shipped kind,
// and of ones with a drive that does something else.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "experiments/verdict/verdict.h"
#include "systems/framework/recording.h"
#include "systems/robot/parallel_robot.h"
#include "tests/experiments/simulated/scenario_of_each_robot.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using Phase = DriveCheckStatus::Phase;

SimulatedScenario checked(const std::string& name, std::vector<std::string> set = {},
                          std::uint64_t seed = 1) {
  set.emplace_back("control.drive_check=true");
  return read_simulated_scenario(test::shipped("scenarios/" + name + ".yaml"), set, seed);
}

class CheckedRobot : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Shipped, CheckedRobot, testing::ValuesIn(test::scenario_of_each_robot),
                         [](const auto& scenario) { return std::string(scenario.param); });

TEST_P(CheckedRobot, PassesHoweverItsRobotIsDrawnAndThenMoves) {
  for (const std::uint64_t seed : {1U, 2U}) {
    SimulatedScenario scenario = checked(GetParam(), {}, seed);
    const Verdict verdict = judge_experiment(scenario);
    const JointVector& gain = verdict.drive_check.gain;
    std::printf("  %-34s seed %d, gains", GetParam(), static_cast<int>(seed));
    for (const double each : gain) std::printf(" %.2f", each);
    std::printf("\n");
    EXPECT_EQ(verdict.drive_check.phase, Phase::passed);
    EXPECT_EQ(gain.size(), scenario.robot.robot->drives());
    EXPECT_EQ(verdict.fault, "");
    EXPECT_FALSE(verdict.contacts.empty() && verdict.detections.empty())
        << "it moves, and runs into something or believes so";
  }
}

/// Until the brakes are closed, with a drive that lies from the start on.
struct Answer {
  DriveCheckStatus check;
  std::string fault;
  double speed = 0.0;   ///< of the platform, at most [m/s]
  double travel = 0.0;  ///< from where it was [m]
};

Answer answer_to(const std::string& name, const std::string& fault) {
  const SimulatedScenario scenario = checked(name, {"faults=[" + fault + "]", "duration_s=0.6"});
  const Recording recording = run_experiment(scenario);
  const Verdict verdict = judge(recording, scenario.robot.robot->space(), {}, scenario.force_limits);
  Answer answer{verdict.drive_check, verdict.fault};
  const int axes = scenario.robot.robot->space_dimension();
  std::vector<double> speed(recording.samples()), way(recording.samples());
  for (int axis = 0; axis < axes; ++axis) {
    const auto velocity = recording.column("truth", "velocity", axis);
    const auto position = recording.column("truth", "pose", axis);
    for (std::size_t k = 0; k < speed.size(); ++k) {
      speed[k] = std::hypot(speed[k], velocity[k]);
      way[k] = std::hypot(way[k], position[k] - position[0]);
    }
  }
  answer.speed = *std::max_element(speed.begin(), speed.end());
  answer.travel = *std::max_element(way.begin(), way.end());
  return answer;
}

TEST(DriveOfTheWrongSign, IsNamedBeforeTheFirstMotionWithinMillimetres) {
  for (const char* const name : {"platform_collision", "five_bar_collision"}) {
    const Answer answer = answer_to(name, "{signal: drive2, kind: scaled, time_s: 0, size: -1}");
    EXPECT_THAT(answer.fault, HasSubstr("wrong sign")) << name;
    EXPECT_EQ(answer.check.drive, 1) << name;
    const double gain = answer.check.gain[1];  // not a number where it was named even before
    EXPECT_TRUE(std::isnan(gain) || std::abs(gain + 1.0) < 0.2) << name << " " << gain;
    EXPECT_LT(answer.speed, 0.3) << name;
    EXPECT_LT(answer.travel, 0.01) << name;
  }
}

TEST(DeadDrive, EndsTheRunBeforeTheFirstMotion) {
  for (const char* const size : {"0", "0.2"}) {
    const Answer answer = answer_to(
        "platform_collision", std::string("{signal: drive2, kind: scaled, time_s: 0, size: ") + size + "}");
    EXPECT_NE(answer.fault, "") << size;
    EXPECT_EQ(answer.check.drive, 1) << size;
    EXPECT_LT(answer.travel, 0.01) << size;
  }
}

TEST(DriveCheckOfARun, IsToldInItsVerdictAndListedWhereItIsOff) {
  const Verdict on = judge_experiment(checked("platform_collision", {"duration_s=0.3"}));
  EXPECT_THAT(on.checks_off, Not(Contains(HasSubstr("drive_check"))));
  const Verdict off = judge_experiment(
      read_simulated_scenario(test::shipped("scenarios/platform_collision.yaml"), {"duration_s=0.3"}));
  EXPECT_EQ(off.drive_check.phase, Phase::unwanted);
  EXPECT_THAT(off.checks_off, Contains(HasSubstr("control.drive_check")));
}

}  // namespace
}  // namespace flinch
