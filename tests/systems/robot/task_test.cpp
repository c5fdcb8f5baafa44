#include "systems/robot/task.h"

#include "systems/robot/reaction_tasks.h"
#include "tests/systems/robot/mechanism_laws.h"

namespace flinch::test {
namespace {

class TaskLaws : public MechanismLaws {};
FLINCH_FOR_ALL_MECHANISMS(TaskLaws);

TEST_P(TaskLaws, DrivesSeeTheSameRateAndAcceleration) {
  Residual rates("J_qa dq_a against J v", 1e-9);
  Residual accelerations("J_qa ddq_a + drift_qa against J dv + drift", 1e-8);
  for (const MotionState& state : states) {
    const Kinematics k = kinematics_at(state.pose, state.velocity);
    const Task task = platform_pose_task(robot, k);
    const DriveTask seen = seen_by_drives(task, k);
    ASSERT_TRUE(seen.valid);
    compare(rates, PlatformVector(seen.J * k.rates.active), task.rate(state.velocity));
    const PlatformVector dv = 3.0 * PlatformVector::LinSpaced(n, -1.0, 2.0);
    const JointVector ddq = k.J_qa_x * dv + k.dJ_qa_x * state.velocity;
    compare(accelerations, PlatformVector(seen.J * ddq + seen.drift),
            PlatformVector(task.J * dv + task.drift));
  }
}

TEST_P(TaskLaws, TheShareAlongADirectionMovesAsTheWholeDoes) {
  for (const MotionState& state : states) {
    const Kinematics k = kinematics_at(state.pose, state.velocity);
    const Task whole = platform_position_task(robot, k);
    const PlatformVector direction = PlatformVector::LinSpaced(whole.rows(), 1.0, 2.0).normalized();
    const Task share = along(whole, direction);
    ASSERT_TRUE(share.valid);
    EXPECT_DOUBLE_EQ(share.sigma[0], direction.dot(whole.sigma));
    EXPECT_NEAR(share.rate(state.velocity)[0], direction.dot(whole.rate(state.velocity)), 1e-12);
  }
}

TEST_P(TaskLaws, StackedTasksKeepTheirRows) {
  const MotionState& state = states.front();
  const Kinematics k = kinematics_at(state.pose, state.velocity);
  const Task first = drive_task(k, 0);
  const Task second = drive_task(k, 1);
  const Task both = stacked(first, second);
  ASSERT_TRUE(both.valid);
  ASSERT_EQ(both.rows(), 2);
  EXPECT_EQ(both.sigma[1], second.sigma[0]);
  EXPECT_EQ(both.J.row(0), first.J.row(0));
  EXPECT_FALSE(stacked(first, no_task(1, n)).valid);
}

TEST_P(TaskLaws, WhatIsNotValidStaysSoAndIsZero) {
  const Kinematics nowhere = kinematics_at(Configuration(), PlatformVector());
  const Task task = platform_position_task(robot, nowhere);
  EXPECT_FALSE(task.valid);
  EXPECT_EQ(task.rows(), robot.space_dimension());
  const DriveTask seen = seen_by_drives(task, nowhere);
  EXPECT_FALSE(seen.valid);
  EXPECT_TRUE(seen.J.isZero(0.0));
  EXPECT_FALSE(along(task, PlatformVector::Ones(n + 1 > max_dof ? 1 : n + 1)).valid);
}

}  // namespace
}  // namespace flinch::test
