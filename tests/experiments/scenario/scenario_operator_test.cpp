#include "experiments/scenario/scenario_operator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <vector>

#include "experiments/scenario/scenario.h"
#include "tests/support/problems_of.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using After = OperatorEvent::After;
using Kind = TargetCommand::Kind;

/// A scenario of a robot that moves, with these entries of `operator`.
std::string moving(const std::string& robot, const std::string& entries) {
  return "robot: ../robots/" + robot + "\nduration_s: 2\n" +
         "motion: {kind: through, poses: [{x_mm: 0}, {x_mm: 20}]}\noperator:\n" + entries;
}

class ScenarioOperator : public testing::Test {
 protected:
  OperatorScript read(const std::string& text) const {
    place_.write("scenarios/own.yaml", text);
    return read_scenario(place_ / "scenarios/own.yaml").operator_script;
  }
  std::vector<std::string> problems(const std::string& text) const {
    return test::problems_of([&] { read(text); });
  }

 private:
  test::Workplace place_;
};

TEST_F(ScenarioOperator, DoesNothingUnlessItIsSaid) {
  EXPECT_THAT(read("robot: ../robots/planar_3rrr.yaml\nduration_s: 1\n").events, IsEmpty());
}

TEST_F(ScenarioOperator, PressesButtonsAndGivesTargetsInOrder) {
  const OperatorScript script = read(moving("planar_3rrr.yaml",
                                            "  - {at_ms: 600, press: stop}\n"
                                            "  - {at_s: 0.7, pose: {x_mm: 30, phi_deg: 9}}\n"
                                            "  - {after: ended, wait_ms: 50, press: reset}\n"
                                            "  - {after: recovering, step: {y_mm: -5}}\n"
                                            "  - {after: arrived, press: start}\n") +
                                     "control: {sequence: {zero_g_when_struck: false}}\n");
  ASSERT_EQ(script.events.size(), 5U);
  const OperatorEvent &stop = script.events[0], &pose = script.events[1], &reset = script.events[2],
                      &step = script.events[3], &start = script.events[4];
  EXPECT_EQ(stop.after, After::time);
  EXPECT_EQ(stop.wait, 600ms);
  EXPECT_TRUE(stop.buttons.stop && !stop.buttons.reset && !stop.buttons.start);
  EXPECT_EQ(stop.target.kind, Kind::none);
  EXPECT_EQ(pose.wait, 700ms);
  EXPECT_FALSE(pose.buttons.stop);
  ASSERT_EQ(pose.target.kind, Kind::pose);
  EXPECT_LT((pose.target.pose - Eigen::Vector3d(0.03, 0.0, std::numbers::pi / 20.0)).norm(), 1e-12);
  EXPECT_EQ(reset.after, After::ended);
  EXPECT_EQ(reset.wait, 50ms);
  EXPECT_TRUE(reset.buttons.reset);
  EXPECT_EQ(step.after, After::recovering);
  EXPECT_EQ(step.wait, 0ms);
  ASSERT_EQ(step.target.kind, Kind::step);
  EXPECT_EQ(step.target.step, Eigen::Vector3d(0.0, -0.005, 0.0));
  EXPECT_EQ(start.after, After::arrived);
  EXPECT_TRUE(start.buttons.start);
  EXPECT_EQ(script.rest_speed, 0.05);
}

TEST_F(ScenarioOperator, GivesTargetsInTheCoordinatesOfTheMechanism) {
  const OperatorScript script = read(
      "robot: ../robots/hexapod_6ups.yaml\nduration_s: 1\noperator:\n"
      "  - {at_s: 0.5, step: {x_mm: 1, z_mm: -2, rotation_rad: [0, 0, 0.1]}}\n");
  PlatformVector step(6);
  step << 0.001, 0.0, -0.002, 0.0, 0.0, 0.1;
  ASSERT_EQ(script.events.size(), 1U);
  EXPECT_EQ(script.events.front().target.step, step);
}

TEST_F(ScenarioOperator, IsToldAllThatIsWrongAtOnce) {
  EXPECT_THAT(
      problems(moving("planar_3rrr.yaml",
                      "  - {at_s: 0.6, press: acknowledge}\n"
                      "  - {at_s: 0.6, press: reset}\n"
                      "  - {at_s: 2, press: reset}\n"
                      "  - {at_s: 1.5, pose: {x_m: 3}}\n"
                      "  - {after: held, press: reset}\n"
                      "  - {after: ended, wait_s: -1, press: reset}\n"
                      "  - {at_s: 1.9, press: start}\n"
                      "  - {after: ended}\n"
                      "  - {press: reset}\n"
                      "  - {after: ended, step: {x_mm: 1, z_mm: 1}}\n"
                      "  - {after: ended, press: reset, step: {x_mm: 1}}\n")),
      testing::UnorderedElementsAre(
          AllOf(HasSubstr("own.yaml:5: "), HasSubstr("press"), HasSubstr("acknowledge")),
          AllOf(HasSubstr("own.yaml:6: "), HasSubstr("is not after that of the entry before it")),
          AllOf(HasSubstr("own.yaml:7: "), HasSubstr("the run ends after 2 s")),
          AllOf(HasSubstr("own.yaml:8: "), HasSubstr("at"), HasSubstr("is not after that of the entry")),
          AllOf(HasSubstr("own.yaml:8: "), HasSubstr("out of the reach of the legs")),
          AllOf(HasSubstr("own.yaml:9: "), HasSubstr("after"), HasSubstr("held")),
          AllOf(HasSubstr("own.yaml:10: "), HasSubstr("wait")),
          AllOf(HasSubstr("own.yaml:11: "), HasSubstr("behind an entry with 'after'")),
          AllOf(HasSubstr("own.yaml:12: "), HasSubstr("press")),
          AllOf(HasSubstr("own.yaml:13: "), HasSubstr("at")),
          AllOf(HasSubstr("own.yaml:14: "), HasSubstr("z_mm")),
          AllOf(HasSubstr("own.yaml:15: "), HasSubstr("step"))));
}

TEST_F(ScenarioOperator, WaitsForNothingThatNeverComes) {
  EXPECT_THAT(problems(moving("planar_3rrr.yaml",
                              "  - {after: recovering, press: start}\n"
                              "  - {after: ended, wait_s: 2, press: reset}\n"
                              "  - {after: recovering, wait_s: 1.9, press: start}\n")),
              testing::UnorderedElementsAre(
                  AllOf(HasSubstr("own.yaml:5: "), HasSubstr("no entry before it presses 'reset'")),
                  AllOf(HasSubstr("own.yaml:6: "), HasSubstr("wait"), HasSubstr("the run ends after 2 s"))));
}

TEST_F(ScenarioOperator, PressesNothingThatIsDownFromTheStart) {
  EXPECT_THAT(problems(moving("planar_3rrr.yaml", "  - {at_s: 0, press: reset}\n")),
              ElementsAre(AllOf(HasSubstr("own.yaml:5: "), HasSubstr("at_s"))));
}

TEST_F(ScenarioOperator, CannotStartWhereThereIsNoMotion) {
  EXPECT_THAT(problems("robot: ../robots/planar_3rrr.yaml\nduration_s: 1\noperator:\n"
                       "  - {at_s: 0.5, press: start}\n"),
              ElementsAre(HasSubstr("there is no nominal motion")));
}

}  // namespace
}  // namespace flinch
