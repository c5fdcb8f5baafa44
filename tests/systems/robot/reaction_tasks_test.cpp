#include "systems/robot/reaction_tasks.h"

#include "tests/systems/robot/mechanism_laws.h"

namespace flinch::test {
namespace {

class ReactionTaskLaws : public MechanismLaws {
 protected:
  /// J against differences of sigma along every coordinate, drift against differences of J v along the
  /// motion.
  template <class TaskAt>
  void check(Residual& gradients, Residual& drifts, const MotionState& state, const TaskAt& task_at) const {
    const Task task = task_at(kinematics_at(state.pose, state.velocity));
    ASSERT_TRUE(task.valid);
    ASSERT_EQ(task.J.rows(), task.rows());
    for (int axis = 0; axis < n; ++axis) {
      const PlatformVector slope = derivative(
          [&](double h) {
            return task_at(kinematics_at(space.plus(state.pose, h * unit(axis)), state.velocity)).sigma;
          },
          tolerances.step);
      compare(gradients, PlatformVector(task.J.col(axis)), slope);
    }
    const PlatformVector drift = derivative(
        [&](double h) { return task_at(kinematics_after(state, h)).rate(state.velocity); }, tolerances.step);
    compare(drifts, task.drift, drift);
  }
};
FLINCH_FOR_ALL_MECHANISMS(ReactionTaskLaws);

TEST_P(ReactionTaskLaws, PositionOfThePlatform) {
  Residual gradients("gradient of x_t against differences", 1e-10);
  Residual drifts("drift of x_t against differences", 1e-10);
  for (const MotionState& state : states) {
    check(gradients, drifts, state, [this](const Kinematics& k) { return platform_position_task(robot, k); });
  }
}

TEST_P(ReactionTaskLaws, DrivesAndPassiveJoints) {
  Residual gradients("gradient of joints against differences", 1e-9);
  Residual drifts("drift of joints against differences", 1e-9);
  for (const MotionState& state : states) {
    for (int j = 0; j < robot.drives(); ++j) {
      check(gradients, drifts, state, [j](const Kinematics& k) { return drive_task(k, j); });
    }
    const Kinematics k = kinematics_at(state.pose, state.velocity);
    for (int j = 0; j < k.joints.passive.size(); ++j) {
      check(gradients, drifts, state, [j](const Kinematics& at) { return passive_joint_task(at, j); });
    }
  }
}

TEST_P(ReactionTaskLaws, PointsOfAllBodies) {
  Residual gradients("gradient of points against differences", 2e-9);
  Residual drifts("drift of points against differences", 2e-9);
  for (const MotionState& state : states) {
    for (const auto& [body, point] : points()) {
      check(gradients, drifts, state, [&, body = body, point = point](const Kinematics& k) {
        return point_task(robot, k, body, point);
      });
    }
  }
}

TEST_P(ReactionTaskLaws, DistanceFromTheCentre) {
  Residual gradients("gradient of the radius against differences", 1e-8);
  Residual drifts("drift of the radius against differences", 1e-8);
  const CartesianVector centre = robot.home_pose().head(robot.space_dimension()).array() + 0.4;
  for (const MotionState& state : states) {
    check(gradients, drifts, state, [&](const Kinematics& k) { return radius_task(robot, k, centre); });
  }
}

TEST_P(ReactionTaskLaws, InTheCentreTheDistanceHasNoGradient) {
  const Kinematics k = kinematics_at(robot.home_pose(), unit(0));
  const Task task = radius_task(robot, k, robot.home_pose().head(robot.space_dimension()));
  EXPECT_TRUE(task.valid);
  EXPECT_EQ(task.sigma[0], 0.0);
  EXPECT_TRUE(task.J.isZero(0.0));
  EXPECT_EQ(task.drift[0], 0.0);
}

TEST_P(ReactionTaskLaws, PositionAndOrientationAreThePose) {
  const MotionState& state = states.front();
  const Kinematics k = kinematics_at(state.pose, state.velocity);
  const Task pose = platform_pose_task(robot, k);
  const Task orientation = platform_orientation_task(robot, k);
  EXPECT_EQ(orientation.rows(), space.rotations());
  EXPECT_EQ(orientation.valid, space.rotations() > 0);
  if (!orientation.valid) return;
  const Task both = stacked(platform_position_task(robot, k), orientation);
  EXPECT_EQ(both.J, pose.J);
  EXPECT_LT((both.sigma - pose.sigma).norm(), 1e-12);
}

TEST_P(ReactionTaskLaws, WhatThereIsNotIsNotValid) {
  const Kinematics k = kinematics_at(robot.home_pose(), unit(0));
  EXPECT_FALSE(drive_task(k, robot.drives()).valid);
  EXPECT_FALSE(drive_task(k, -1).valid);
  EXPECT_FALSE(passive_joint_task(k, static_cast<int>(k.joints.passive.size())).valid);
  EXPECT_FALSE(point_task(robot, k, BodyId::from_index(robot.body_count()),
                          CartesianVector::Zero(robot.space_dimension()))
                   .valid);
  EXPECT_FALSE(radius_task(robot, k, CartesianVector()).valid);
}

TEST_P(ReactionTaskLaws, OutOfReachNoTaskIsValid) {
  const Kinematics nowhere = kinematics_at(Configuration(), PlatformVector());
  const CartesianVector origin = CartesianVector::Zero(robot.space_dimension());
  for (const Task& task :
       {platform_position_task(robot, nowhere), platform_pose_task(robot, nowhere), drive_task(nowhere, 0),
        passive_joint_task(nowhere, 0), point_task(robot, nowhere, BodyId::platform(), origin),
        radius_task(robot, nowhere, origin)}) {
    EXPECT_FALSE(task.valid);
    EXPECT_TRUE(task.J.isZero(0.0));
    EXPECT_TRUE(task.sigma.isZero(0.0));
  }
}

}  // namespace
}  // namespace flinch::test
