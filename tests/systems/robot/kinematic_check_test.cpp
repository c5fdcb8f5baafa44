#include "systems/robot/kinematic_check.h"

#include <gtest/gtest.h>

#include "systems/robot/five_bar.h"
#include "systems/robot/five_bar_presets.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"

namespace flinch {
namespace {

WorkingMode flipped(WorkingMode mode, int leg) {
  mode[leg] = 1 - mode[leg];
  return mode;
}

JointVector drives_at_home(const ParallelRobot& robot, const WorkingMode& mode) {
  return robot.inverse_kinematics(robot.home_pose(), mode).joints.active;
}

/// A leg that passes its fold goes on with its elbow on the other side.
TEST(KinematicCheck, FollowsALegThroughItsFold) {
  const FiveBar robot(five_bar_robot());
  const WorkingMode home = robot.home_working_mode();
  std::vector<JointVector> rows;
  for (const WorkingMode& mode : {home, flipped(home, 0)})
    rows.insert(rows.end(), 5, drives_at_home(robot, mode));
  const KinematicCheck check = check_kinematics(robot, rows);
  EXPECT_EQ(check.valid_fraction, 1.0);
  ASSERT_EQ(check.folds().size(), 1U);
  EXPECT_EQ(check.folds()[0].leg, 0);
  EXPECT_EQ(check.folds()[0].row, 5U);
  EXPECT_FALSE(check.folds_from_home(robot));
  EXPECT_LT((check.stretches[1].pose - robot.home_pose()).norm(), 1e-9);
}

TEST(KinematicCheck, SaysThatTheRowsBeginBeyondAFold) {
  const FiveBar robot(five_bar_robot());
  const WorkingMode other = flipped(robot.home_working_mode(), 1);
  const KinematicCheck check = check_kinematics(robot, {drives_at_home(robot, other)});
  EXPECT_TRUE(check.folds_from_home(robot));
  EXPECT_TRUE(check.folds().empty());
}

template <class Robot>
void expect_other_assemblies(const Robot& robot) {
  for (int leg = 0; leg < robot.legs(); ++leg) {
    const WorkingMode mode = flipped(robot.home_working_mode(), leg);
    const std::shared_ptr<const ParallelRobot> other = robot.assembled_as(mode);
    ASSERT_NE(other, nullptr);
    EXPECT_EQ(other->home_working_mode(), mode);
    EXPECT_EQ(other->home_pose(), robot.home_pose());
    EXPECT_EQ(drives_at_home(*other, mode), drives_at_home(robot, mode));
  }
  EXPECT_EQ(robot.assembled_as(WorkingMode::Constant(robot.legs(), 2)), nullptr);
}

TEST(AssembledAs, IsTheSameRobotWithAnElbowOnItsOtherSide) {
  expect_other_assemblies(FiveBar(five_bar_robot()));
  expect_other_assemblies(PlanarRrr(rig_robot(RigGeometry::individual, RigFriction::none)));
}

}  // namespace
}  // namespace flinch
