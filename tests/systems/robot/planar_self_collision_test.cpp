#include "systems/robot/planar_self_collision.h"

#include <numbers>

#include "systems/robot/link_segments.h"
#include "tests/systems/robot/differences.h"
#include "tests/systems/robot/random_motion.h"
#include "tests/systems/robot/reference_3rrr.h"
#include "tests/systems/robot/residual.h"

namespace flinch::test {
namespace {

class CouplingAngle : public BothGeometries {};
FLINCH_FOR_BOTH_GEOMETRIES(CouplingAngle);

TEST_P(CouplingAngle, GradientAndDriftAgreeWithDifferences) {
  Residual gradients("gradient of omega against differences", 1e-8);
  Residual drifts("drift of omega against differences", 1e-7);
  for (const PoseAndVelocity& motion : motions) {
    const auto& pose = motion.pose;
    const auto& velocity = motion.velocity;
    for (int leg = 0; leg < 3; ++leg) {
      const auto task_at = [&](const Eigen::Vector3d& moved) {
        return coupling_angle_task(robot, kinematics_at(moved, velocity), leg);
      };
      const Task task = task_at(pose);
      ASSERT_TRUE(task.valid);
      for (int axis = 0; axis < 3; ++axis) {
        const double slope = derivative(
            [&](double h) { return task_at(pose + h * Eigen::Vector3d::Unit(axis)).sigma[0]; }, 1e-4);
        gradients.add((task.J(0, axis) - slope) / std::max(1.0, std::abs(slope)));
      }
      const double drift =
          derivative([&](double h) { return task_at(pose + h * velocity).rate(velocity)[0]; }, 1e-4);
      drifts.add((task.drift[0] - drift) / std::max(1.0, std::abs(drift)));
    }
  }
}

TEST_P(CouplingAngle, TheLargestAngleOfADistanceIsReachedWhereThatDistanceIs) {
  Residual residual("largest omega against omega_max(sigma_sc) [rad]", 1e-7);
  for (const auto& [pose, velocity] : random_motions(robot, 3000, 2)) {
    const Kinematics k = kinematics_at(pose, velocity);
    const double distance = self_collision_distance(robot, k);
    if (distance < 0.1 || distance > 0.185) continue;
    double omega = 0.0;
    for (int leg = 0; leg < 3; ++leg) omega = std::max(omega, coupling_angle_task(robot, k, leg).sigma[0]);
    residual.add(omega - largest_coupling_angle(robot, distance));
  }
}

TEST_P(CouplingAngle, ThePublishedSafetyValueIsAnAngleOf83Degrees) {
  EXPECT_NEAR(largest_coupling_angle(robot, 0.17) * 180.0 / std::numbers::pi, 83.47, 0.005);
  EXPECT_NEAR(largest_coupling_angle(robot, 0.12) * 180.0 / std::numbers::pi, 109.6, 0.05);
  EXPECT_DOUBLE_EQ(largest_coupling_angle(robot, 1.0), std::numbers::pi / 3.0);
}

TEST_P(CouplingAngle, OutOfReachOrOfALegThatThereIsNotIsNotValid) {
  const Kinematics nowhere = kinematics_at(Eigen::Vector3d(9, 0, 0), Eigen::Vector3d::Zero());
  EXPECT_FALSE(coupling_angle_task(robot, nowhere, 0).valid);
  const Kinematics home = kinematics_at(robot.home_pose(), Eigen::Vector3d::Zero());
  EXPECT_FALSE(coupling_angle_task(robot, home, 3).valid);
  EXPECT_FALSE(coupling_angle_task(robot, home, -1).valid);
}

}  // namespace
}  // namespace flinch::test
