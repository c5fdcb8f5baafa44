#include "systems/robot/joint_space_dynamics.h"
#include "tests/systems/robot/random_motion.h"
#include "tests/systems/robot/residual.h"

namespace flinch::test {
namespace {

class EquationsOfMotion : public BothGeometries {};
FLINCH_FOR_BOTH_GEOMETRIES(EquationsOfMotion);

TEST_P(EquationsOfMotion, CoriolisMatrixIsTheChristoffelMatrix) {
  Residual residual("C_x against numeric Christoffel symbols", 3e-9);
  for (const PoseAndVelocity& motion : motions) {
    const auto& pose = motion.pose;
    const auto& velocity = motion.velocity;
    std::array<Eigen::Matrix3d, 3> dM;
    for (int k = 0; k < 3; ++k) {
      dM[static_cast<std::size_t>(k)] = derivative(
          [&](double h) -> Eigen::Matrix3d {
            return dynamics_at(pose + h * Eigen::Vector3d::Unit(k), velocity).M_x;
          },
          3e-4);
    }
    const auto partial = [&](int k, int i, int j) { return dM[static_cast<std::size_t>(k)](i, j); };
    Eigen::Matrix3d C = Eigen::Matrix3d::Zero();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        for (int k = 0; k < 3; ++k) {
          C(i, j) += 0.5 * (partial(k, i, j) + partial(j, i, k) - partial(i, j, k)) * velocity[k];
        }
      }
    }
    residual.add(dynamics_at(pose, velocity).C_x, C);
  }
}

TEST_P(EquationsOfMotion, HorizontalRobotNeedsNoTorqueAgainstGravity) {
  EXPECT_EQ(dynamics_at(Eigen::Vector3d(0.1, 0, 0), Eigen::Vector3d(1, 1, 1)).g_x, Eigen::Vector3d::Zero());
}

TEST(EquationsOfMotionAtHome, HaveThePublishedValues) {
  const PlanarRrr robot(rig_robot(RigGeometry::nominal, RigFriction::none));
  Kinematics k;
  Dynamics dynamics;
  robot.kinematics(robot.home_pose(), PlatformVector::Zero(3), k);
  robot.dynamics(k, dynamics);
  const Eigen::Matrix3d M = Eigen::Vector3d(3.901, 3.901, 0.05114).asDiagonal();
  EXPECT_LT((dynamics.M_x - M).lpNorm<Eigen::Infinity>(), 5e-4);
  EXPECT_NEAR(dynamics.M_x(2, 2), 0.05114, 5e-6);
  const JointSpaceDynamics joints = joint_space_dynamics(k, dynamics);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(joints.M_qa(i, j), i == j ? 0.579 : -0.0425, 5e-4);
  }
}

}  // namespace
}  // namespace flinch::test
