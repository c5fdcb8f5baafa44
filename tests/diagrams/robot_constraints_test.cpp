#include "diagrams/robot_constraints.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "systems/config/robot_file.h"
#include "systems/robot/link_segments.h"

namespace flinch {
namespace {

RobotFile shipped(const std::string& name) {
  return read_robot_file(FLINCH_SOURCE_DIR "/apps/robots/" + name + ".yaml");
}

struct AtHome {
  explicit AtHome(const RobotFile& file) : constraints(constraints_for(*file.robot, file.limits)) {
    const ParallelRobot& robot = *file.robot;
    robot.kinematics(robot.home_pose(), PlatformVector::Zero(robot.dof()), kinematics);
    sigma_sc = self_collision_distance(robot, kinematics);
  }
  ConstraintSettings constraints;
  Kinematics kinematics;
  double sigma_sc = 0.0;
};

TEST(RobotConstraints, AreThoseOfThePapersAtTheRig) {
  const AtHome rig(shipped("planar_3rrr"));
  EXPECT_EQ(rig.constraints.sigma_kappa.activation, 12.0);
  EXPECT_EQ(rig.constraints.sigma_kappa.safety, 15.0);
  EXPECT_EQ(rig.constraints.sigma_sc.activation, 0.178);
  EXPECT_EQ(rig.constraints.sigma_sc.safety, 0.17);
}

TEST(RobotConstraints, HaveEveryShippedRobotInsideThemAtHome) {
  for (const char* const name : {"planar_3rrr", "five_bar", "planar_3rpr", "planar_4rrr", "delta",
                                 "hexa_6rus", "hexapod_6ups", "linapod_6pus", "tricept"}) {
    const AtHome home(shipped(name));
    const ConstraintSettings& constraints = home.constraints;
    EXPECT_LT(home.kinematics.sigma_kappa, constraints.sigma_kappa.activation) << name;
    EXPECT_LT(constraints.sigma_kappa.activation, constraints.sigma_kappa.safety) << name;
    EXPECT_GT(home.sigma_sc, constraints.sigma_sc.activation) << name;
    EXPECT_GT(constraints.sigma_sc.activation, constraints.sigma_sc.safety) << name;
    EXPECT_GT(constraints.sigma_sc.safety, 0.0) << name;
  }
}

// The arms of the 6-RUS are 40 mm thick, the axes of its rods are 74.8 mm apart at home.
TEST(RobotConstraints, KeepLinksThatAreNearAtHomeFromTouching) {
  const AtHome hexa(shipped("hexa_6rus"));
  EXPECT_NEAR(hexa.sigma_sc, 0.0748, 1e-4);
  EXPECT_NEAR(hexa.constraints.sigma_sc.safety, 0.04 + 0.25 * (hexa.sigma_sc - 0.04), 1e-12);
  EXPECT_NEAR(hexa.constraints.sigma_sc.activation, 0.04 + 0.5 * (hexa.sigma_sc - 0.04), 1e-12);
}

TEST(RobotConstraints, GoByTheDistanceOfTheFileWhereThatIsMore) {
  RobotFile file = shipped("hexa_6rus");
  file.limits.min_self_collision_distance = 0.06;
  const AtHome home(file);
  EXPECT_NEAR(home.constraints.sigma_sc.safety, 0.06 + 0.25 * (home.sigma_sc - 0.06), 1e-12);
  file.limits.min_self_collision_distance = 0.08;
  EXPECT_NEAR(AtHome(file).constraints.sigma_sc.safety, 0.625 * home.sigma_sc, 1e-12);
}

// The condition number counts angles at the characteristic length: as short as one likes, it is as large.
TEST(RobotConstraints, AreScaledForARobotWithALargeConditionNumberAtHome) {
  std::ifstream stream(FLINCH_SOURCE_DIR "/apps/robots/hexa_6rus.yaml");
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  const std::string length = "characteristic_length_m: 0.18";
  text.replace(text.find(length), length.size(), "characteristic_length_m: 0.002");
  const AtHome home(parse_robot_file(text, "robot.yaml"));
  ASSERT_GT(home.kinematics.sigma_kappa, 12.0);
  EXPECT_NEAR(home.constraints.sigma_kappa.activation, 1.5 * home.kinematics.sigma_kappa, 1e-9);
  EXPECT_NEAR(home.constraints.sigma_kappa.safety, 1.9 * home.kinematics.sigma_kappa, 1e-9);
}

}  // namespace
}  // namespace flinch
