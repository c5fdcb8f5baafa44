#include "systems/robot/joint_space_dynamics.h"
#include "tests/systems/robot/random_motion.h"
#include "tests/systems/robot/residual.h"

namespace flinch::testing {
namespace {

class EquationsOfMotion : public BothGeometries {};
FLINCH_FOR_BOTH_GEOMETRIES(EquationsOfMotion);

// M_x as the sum over rigid bodies of m J_v^T J_v + I J_w^T J_w at their centres of mass.
Eigen::Matrix3d mass_matrix_of_bodies(const PlanarRrr& robot, const Kinematics& k) {
  const PlanarRrrParameters& parameters = robot.parameters();
  Eigen::Matrix3d M =
      Eigen::Vector3d(parameters.platform_mass, parameters.platform_mass, parameters.platform_inertia)
          .asDiagonal();
  for (int leg = 0; leg < 3; ++leg) {
    const std::pair<BodyId, LinkBody> bodies[] = {{BodyId::link1(leg), bench_link1()},
                                                  {BodyId::link2(leg), bench_link2()}};
    for (const auto& [id, body] : bodies) {
      const ContactJacobian J = robot.contact_jacobian(k, id, Eigen::Vector2d(body.centre_of_mass, 0.0));
      M += body.mass * J.translation.transpose() * J.translation +
           body.inertia * J.rotation.transpose() * J.rotation;
    }
  }
  return M;
}

TEST_P(EquationsOfMotion, MassMatrixIsTheSumOverAllBodies) {
  PlanarRrrParameters parameters = bench_robot(GetParam(), BenchFriction::none);
  for (PlanarRrrLeg& leg : parameters.legs) {
    leg.inertia = base_parameters(bench_link1(), bench_link2(), leg.link1_length);
  }
  const PlanarRrr bodies(parameters);
  Residual residual("M_x against the sum over bodies, relative to |M_x|", 1e-15);
  for (const auto& [pose, velocity] : motions) {
    Kinematics k;
    Dynamics dynamics;
    bodies.kinematics(pose, velocity, k);
    bodies.dynamics(k, dynamics);
    const Eigen::Matrix3d M_x = dynamics.M_x;
    residual.add((M_x - mass_matrix_of_bodies(bodies, k)).lpNorm<Eigen::Infinity>() /
                 M_x.lpNorm<Eigen::Infinity>());
  }
}

TEST_P(EquationsOfMotion, MassMatrixChangesByCoriolisMatrixPlusItsTranspose) {
  Residual residual("dM_x/dt = C_x + C_x^T", 3e-9);
  for (const PoseAndVelocity& motion : motions) {
    const auto& pose = motion.pose;
    const auto& velocity = motion.velocity;
    const Eigen::Matrix3d C = dynamics_at(pose, velocity).C_x;
    const auto M_along = [&](double h) -> Eigen::Matrix3d {
      return dynamics_at(pose + h * velocity, velocity).M_x;
    };
    residual.add(Eigen::Matrix3d(C + C.transpose()), derivative(M_along, 1e-4));
  }
}

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

TEST_P(EquationsOfMotion, MassMatrixIsSymmetricAndPositiveDefinite) {
  Residual asymmetry("asymmetry of M_x", 1e-15);
  for (const auto& [pose, velocity] : motions) {
    const Eigen::Matrix3d M = dynamics_at(pose, velocity).M_x;
    asymmetry.add(M, Eigen::Matrix3d(M.transpose()));
    EXPECT_EQ(M.llt().info(), Eigen::Success);
  }
}

TEST_P(EquationsOfMotion, FrictionOpposesTheJointsThatMove) {
  Residual residual("friction wrench against joint torques [N, Nm]", 2e-13);
  for (const auto& [pose, velocity] : motions) {
    const Kinematics k = kinematics_at(pose, velocity);
    Eigen::Vector3d wrench = Eigen::Vector3d::Zero();
    for (int i = 0; i < 3; ++i) {
      const PlanarRrrLeg& leg = robot.parameters().legs[static_cast<std::size_t>(i)];
      const auto torque = [](const JointFriction& friction, double rate) {
        return friction.viscous * rate + friction.coulomb * std::tanh(rate / 0.01);
      };
      wrench += torque(leg.active_friction, k.rates.active[i]) * k.J_qa_x.row(i).transpose();
      wrench += torque(leg.passive_friction, k.rates.passive[i]) * k.J_qp_x.row(i).transpose();
    }
    const Dynamics dynamics = dynamics_at(pose, velocity);
    residual.add(dynamics.F_fr_x, wrench);
    EXPECT_GE(dynamics.F_fr_x.dot(velocity), 0.0);
  }
}

TEST_P(EquationsOfMotion, HorizontalRobotNeedsNoTorqueAgainstGravity) {
  EXPECT_EQ(dynamics_at(Eigen::Vector3d(0.1, 0, 0), Eigen::Vector3d(1, 1, 1)).g_x, Eigen::Vector3d::Zero());
}

TEST_P(EquationsOfMotion, RotorInertiaAddsToItsOwnDrive) {
  PlanarRrrParameters parameters = robot.parameters();
  parameters.legs[1].rotor_inertia = 0.2;
  const PlanarRrr heavier(parameters);
  Residual residual("mass matrix with a rotor", 1e-14);
  for (const auto& [pose, velocity] : motions) {
    const Kinematics k = kinematics_at(pose, velocity);
    Dynamics dynamics;
    heavier.dynamics(k, dynamics);
    const Eigen::RowVector3d row = k.J_qa_x.row(1);
    residual.add(dynamics.M_x,
                 Eigen::Matrix3d(dynamics_at(pose, velocity).M_x + 0.2 * row.transpose() * row));
  }
}

TEST_P(EquationsOfMotion, JointSpaceFormHasTheSameSolution) {
  Residual acceleration("accelerations from both forms, relative", 1e-12);
  Residual passivity("dM_qa/dt = C_qa + C_qa^T", 3e-9);
  for (const PoseAndVelocity& motion : motions) {
    const auto& pose = motion.pose;
    const auto& velocity = motion.velocity;
    const Kinematics k = kinematics_at(pose, velocity);
    const Dynamics dynamics = dynamics_at(pose, velocity);
    const JointSpaceDynamics joints = joint_space_dynamics(k, dynamics);
    ASSERT_TRUE(joints.valid);
    const Eigen::Vector3d torque(3.0, -2.0, 5.0);
    const Eigen::Vector3d ddq = Eigen::Matrix3d(joints.M_qa).inverse() *
                                (torque - joints.C_qa * k.rates.active - joints.g_qa - joints.tau_fr_qa);
    const Eigen::Vector3d from_joints = k.J_x_qa * ddq + k.dJ_x_qa * k.rates.active;
    const Eigen::Vector3d from_platform =
        Eigen::Matrix3d(dynamics.M_x).inverse() *
        (platform_wrench(k, torque) - dynamics.C_x * velocity - dynamics.g_x - dynamics.F_fr_x);
    acceleration.add((from_joints - from_platform).norm() / from_platform.norm());

    const auto M_along = [&](double h) -> Eigen::Matrix3d {
      const Eigen::Vector3d moved = pose + h * velocity;
      return joint_space_dynamics(kinematics_at(moved, velocity), dynamics_at(moved, velocity)).M_qa;
    };
    passivity.add(Eigen::Matrix3d(joints.C_qa + joints.C_qa.transpose()), derivative(M_along, 1e-4));
  }
}

TEST(EquationsOfMotionAtHome, HaveThePublishedValues) {
  const PlanarRrr robot(bench_robot(BenchGeometry::nominal, BenchFriction::none));
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

TEST(JointSpaceForm, IsInvalidAndFiniteWhereThePoseIsOutOfReach) {
  const PlanarRrr robot(bench_robot(BenchGeometry::nominal, BenchFriction::none));
  Kinematics k;
  Dynamics dynamics;
  robot.kinematics(Eigen::Vector3d(9, 0, 0), PlatformVector::Zero(3), k);
  robot.dynamics(k, dynamics);
  const JointSpaceDynamics joints = joint_space_dynamics(k, dynamics);
  EXPECT_FALSE(joints.valid);
  EXPECT_TRUE(joints.M_qa.allFinite());
}

}  // namespace
}  // namespace flinch::testing
