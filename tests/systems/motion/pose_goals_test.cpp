#include "systems/motion/pose_goals.h"

#include <gtest/gtest.h>

#include "systems/framework/diagram_builder.h"
#include "systems/robot/five_bar.h"
#include "systems/robot/five_bar_presets.h"
#include "tests/support/planar_rig.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

struct Goals {
  explicit Goals(std::shared_ptr<const ParallelRobot> of) : robot(std::move(of)) {}

  const TaskList& at(const PlatformReference& desired, const PlatformVector& pose) {
    Kinematics now;
    robot->kinematics(pose, PlatformVector::Zero(robot->dof()), now);
    ticking.set(reference, desired);
    ticking.set(kinematics, now);
    ticking.tick();
    return ticking.get(block.goals);
  }

  std::shared_ptr<const ParallelRobot> robot;
  DiagramBuilder builder{"test", 1ms};
  PoseGoals& block = builder.add<PoseGoals>("goals", robot, PoseGoalSettings());
  InputPort<PlatformReference> reference = builder.export_input("reference", block.reference);
  InputPort<Kinematics> kinematics = builder.export_input("kinematics", block.kinematics);
  test::Ticking ticking{builder};
};

TEST(PoseGoals, AreThePositionAndBelowItTheOrientation) {
  Goals goals(test::planar_rig());
  const PlatformReference desired{true, false, Eigen::Vector3d(0.03, -0.02, 3.0), Eigen::Vector3d(1, 2, 3),
                                  Eigen::Vector3d(4, 5, 6)};
  const TaskList& list = goals.at(desired, Eigen::Vector3d(0.01, 0.01, 0.1));
  ASSERT_TRUE(list.valid);
  ASSERT_EQ(list.count, 2);
  EXPECT_LT((list.goals[0].reference.error - Eigen::Vector2d(0.02, -0.03)).norm(), 1e-15);
  EXPECT_EQ(list.goals[0].reference.rate, Eigen::Vector2d(1, 2));
  EXPECT_EQ(list.goals[0].gains.force, Eigen::Vector2d(2000, 2000));
  EXPECT_NEAR(list.goals[1].reference.error[0], 2.9, 1e-12);
  EXPECT_EQ(list.goals[1].reference.acceleration[0], 6.0);
}

TEST(PoseGoals, OfAPointAreItsPositionAlone) {
  const auto robot = std::make_shared<FiveBar>(five_bar_robot());
  Goals goals(robot);
  const PlatformVector zero = PlatformVector::Zero(2);
  const TaskList& list = goals.at({true, false, robot->home_pose(), zero, zero}, robot->home_pose());
  ASSERT_TRUE(list.valid);
  EXPECT_EQ(list.count, 1);
}

TEST(PoseGoals, WithoutAReferenceThatFitsAreNotValid) {
  Goals goals(test::planar_rig());
  const PlatformVector home = PlatformVector::Zero(3);
  EXPECT_FALSE(goals.at(PlatformReference(), home).valid);
  EXPECT_FALSE(goals.at({true, false, home, PlatformVector::Zero(2), home}, home).valid);
  EXPECT_FALSE(goals.at({true, false, home, home, home}, Eigen::Vector3d(9, 9, 9)).valid);
}

}  // namespace
}  // namespace flinch
