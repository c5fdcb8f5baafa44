#include "experiments/bus/operator_order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "experiments/scenario/scenario.h"
#include "systems/foundation/setup_error.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::HasSubstr;
using Kind = TargetCommand::Kind;

const Scenario& scenario(const std::string& name) {
  static std::map<std::string, Scenario> read;
  const auto found = read.find(name);
  if (found != read.end()) return found->second;
  return read.emplace(name, read_scenario(test::shipped("scenarios/" + name + ".yaml"))).first->second;
}

OperatorOrder order(const std::string& line, const std::string& name = "square") {
  return read_order(line, scenario(name));
}

std::string refusal_of(const std::string& line, const std::string& name = "square") {
  try {
    order(line, name);
  } catch (const SetupError& error) {
    return error.what();
  }
  return "taken";
}

TEST(OperatorOrder, PressesOneButtonOrNone) {
  const auto pressed = [](const OperatorCommand& buttons) {
    return std::vector<bool>{buttons.stop, buttons.reset, buttons.start};
  };
  EXPECT_EQ(pressed(order("stop").buttons), (std::vector{true, false, false}));
  EXPECT_EQ(pressed(order("reset").buttons), (std::vector{false, true, false}));
  EXPECT_EQ(pressed(order("start").buttons), (std::vector{false, false, true}));
  for (const std::string line : {"end", "go", "step x_mm: 1"}) {
    EXPECT_EQ(pressed(order(line).buttons), (std::vector{false, false, false})) << line;
    EXPECT_EQ(order(line).end, line == "end");
  }
  EXPECT_EQ(order(" \t stop  ").target.kind, Kind::none);
}

TEST(OperatorOrder, LeadsToAPoseByTheKeysOfAScenario) {
  const OperatorOrder there = order("go x_mm: 20, y_mm: -10, phi_deg: 3");
  ASSERT_EQ(there.target.kind, Kind::pose);
  EXPECT_NEAR(there.target.pose[0], 0.02, 1e-15);
  EXPECT_NEAR(there.target.pose[1], -0.01, 1e-15);
  EXPECT_NEAR(there.target.pose[2], 3.0 * std::numbers::pi / 180.0, 1e-15);
}

TEST(OperatorOrder, LeadsHomeWhereNoKeyIsGiven) {
  for (const std::string name : {"square", "hexapod_collision", "five_bar_collision"}) {
    const OperatorOrder home = order("go", name);
    const ParallelRobot& robot = *scenario(name).robot.robot;
    ASSERT_EQ(home.target.kind, Kind::pose);
    EXPECT_LT(robot.difference(home.target.pose, robot.home_pose()).head(robot.space().translations()).norm(),
              1e-12)
        << name;
  }
}

TEST(OperatorOrder, StepsByTheKeysOfTheRobot) {
  const OperatorOrder planar = order("step y_m: 0.005");
  ASSERT_EQ(planar.target.kind, Kind::step);
  EXPECT_EQ(planar.target.step, PlatformVector(Eigen::Vector3d(0.0, 0.005, 0.0)));
  const OperatorOrder spatial = order("step z_mm: 4, rotation_deg: [0, 0, 90]", "hexapod_collision");
  EXPECT_NEAR(spatial.target.step[2], 0.004, 1e-15);
  EXPECT_NEAR(spatial.target.step[5], std::numbers::pi / 2.0, 1e-12);
}

TEST(OperatorOrder, IsRefusedWithTheWayOut) {
  EXPECT_EQ(refusal_of("stp"), "'stp' is no order; did you mean 'stop'?");
  EXPECT_EQ(refusal_of("reset 5"), "'5' behind 'reset' means nothing");
  EXPECT_THAT(refusal_of("go x_mm: 900"), HasSubstr("go: is out of the reach of the legs"));
  EXPECT_THAT(refusal_of("go x: 9"), HasSubstr("go.x"));
  EXPECT_THAT(refusal_of("step z_mm: 9"), HasSubstr("step.z_mm: is not a known key"));
  EXPECT_THAT(refusal_of("step x_mm: nan"), HasSubstr("step.x_mm: "));
  EXPECT_THAT(refusal_of("start", "stiffness"),
              HasSubstr("'start' begins the motion of the scenario, which"));
}

TEST(OperatorOrder, IsNeverUnderstoodFromGarbage) {
  for (const std::string line :
       {"go }", "go }, go: {x_mm: 3", "go {", "go x_mm", "go 3", "go [", "go x_mm: 1, x_mm: 2", "step &a *a",
        "step x_mm: 1\n}", "\x01\x02", "go \"", "go x_mm: 1e999", "STOP", "stop;reset"}) {
    EXPECT_NE(refusal_of(line), "taken") << line;
  }
}

}  // namespace
}  // namespace flinch
