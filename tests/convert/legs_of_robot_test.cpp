#include "convert/legs_of_robot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "systems/config/robot_file.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/dynamics.h"
#include "systems/robot/legs/legs_robot.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class ClosedForm : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Robots, ClosedForm,
                         testing::Values("planar_3rrr", "planar_3rrr_nominal", "five_bar", "hexapod_6ups"),
                         [](const auto& each) { return std::string(each.param); });

TEST_P(ClosedForm, MovesAlikeAsLegs) {
  const RobotFile file =
      read_robot_file(FLINCH_SOURCE_DIR "/apps/robots/" + std::string(GetParam()) + ".yaml");
  const ParallelRobot& robot = *file.robot;
  const LegsRobot legs(as_legs(robot));
  std::mt19937 generator(5);
  const auto draw = [&](double limit) {
    PlatformVector drawn(robot.dof());
    for (double& entry : drawn) entry = std::uniform_real_distribution<double>(-limit, limit)(generator);
    return drawn;
  };
  for (int i = 0; i < 30; ++i) {
    const Configuration pose = robot.space().plus(robot.home_pose(), draw(0.05));
    const PlatformVector velocity = draw(0.8);
    Kinematics a, b;
    Dynamics of_a, of_b;
    robot.kinematics(pose, velocity, a);
    legs.kinematics(pose, velocity, b);
    ASSERT_TRUE(a.valid && b.valid);
    robot.dynamics(a, of_a);
    legs.dynamics(b, of_b);
    EXPECT_TRUE(b.joints.active.isApprox(a.joints.active, 1e-11)) << i;
    EXPECT_TRUE(b.J_qa_x.isApprox(a.J_qa_x, 1e-10)) << i;
    EXPECT_TRUE(of_b.M_x.isApprox(of_a.M_x, 1e-10)) << i;
    EXPECT_TRUE((of_b.C_x * velocity).isApprox(of_a.C_x * velocity, 1e-9)) << i;
    EXPECT_LT((of_b.g_x - of_a.g_x).norm(), 1e-9 * (1.0 + of_a.g_x.norm())) << i;
    EXPECT_TRUE(of_b.F_fr_x.isApprox(of_a.F_fr_x, 1e-9)) << i;
  }
}

TEST(LegsOfARobot, RefuseInertiaThatNoTwoLinksHave) {
  PlanarRrrParameters parameters = rig_robot(RigGeometry::nominal, RigFriction::none);
  parameters.legs[0].inertia.p3 = 0.0;
  EXPECT_THAT(test::problems_of([&] { as_legs(PlanarRrr(parameters)); }),
              ElementsAre(HasSubstr("base_parameters: no two links")));
}

}  // namespace
}  // namespace flinch
