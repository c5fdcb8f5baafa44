#include "systems/robot/impedance_damping.h"
#include "systems/robot/joint_space_dynamics.h"
#include "systems/robot/link_segments.h"
#include "tests/support/allocations.h"
#include "tests/systems/robot/random_motion.h"

namespace flinch::testing {
namespace {

// Everything that a control tick may call.
void evaluate_all(const ParallelRobot& robot, const PlatformVector& pose, const PlatformVector& velocity) {
  Kinematics kinematics;
  Dynamics dynamics;
  robot.kinematics(pose, velocity, kinematics);
  robot.dynamics(kinematics, dynamics);
  const WorkingMode mode = robot.working_mode(kinematics.joints.passive);
  const PlatformVector start = robot.start_pose(kinematics.joints.active, kinematics.joints.passive);
  const ForwardSolution forward = robot.forward_kinematics(kinematics.joints.active, start, mode);
  const InverseSolution inverse = robot.inverse_kinematics(forward.pose, robot.home_working_mode());
  robot.chain_closure_error(inverse.joints.active, inverse.joints.passive, robot.home_pose());
  robot.difference(pose, forward.pose);
  ParallelRobot::passive_difference(inverse.joints.active, kinematics.joints.active);

  const JointSpaceDynamics joints = joint_space_dynamics(kinematics, dynamics);
  for (int i = 0; i < robot.body_count(); ++i) {
    const BodyId body = BodyId::from_index(i);
    const CartesianVector point = robot.axis_point(body, 0.3);
    const ContactJacobian contact = robot.contact_jacobian(kinematics, body, point);
    const CartesianVector force = robot.point_on_body(kinematics, body, point);
    from_active_joints(contact, kinematics);
    const JointVector torques = drive_torques(kinematics, clamping_wrench(contact, force, contact, force));
    platform_wrench(kinematics, torques);
  }
  self_collision_distance(robot, kinematics);
  const PlatformMatrix K = PlatformMatrix::Identity(3, 3) * 85.0;
  impedance_damping(joints.M_qa, K, PlatformVector::Ones(3));
  modal_damping(dynamics.valid ? dynamics.M_x : K, K, PlatformVector::Ones(3));
}

TEST(ControlPath, NeverAllocates) {
  const PlanarRrr robot(bench_robot(BenchGeometry::individual, BenchFriction::test_bench));
  const std::vector<PoseAndVelocity> motions = random_motions(robot, 100);
  const test::AllocationCounter counter;
  for (const auto& [pose, velocity] : motions) evaluate_all(robot, pose, velocity);
  evaluate_all(robot, Eigen::Vector3d(9.0, 0.0, 0.0), Eigen::Vector3d(0.0, 0.0, 0.0));
  EXPECT_EQ(counter.count(), 0);
}

TEST(SimulationPath, NeverAllocates) {
  const PlanarRrr robot(bench_robot(BenchGeometry::individual, BenchFriction::test_bench));
  const std::vector<PoseAndVelocity> motions = random_motions(robot, 100);
  const test::AllocationCounter counter;
  double sum = 0.0;
  for (const auto& [pose, velocity] : motions) {
    const PlanarMotion motion = robot.motion(pose, velocity);
    const Eigen::Vector2d force = point_velocity(motion, BodyId::link2(1), Eigen::Vector2d(0.1, 0.2));
    const Eigen::Vector3d wrench = contact_wrench(motion, BodyId::link2(1), Eigen::Vector2d(0.1, 0.2), force);
    sum += robot.acceleration(pose, velocity, Eigen::Vector3d(1.0, 2.0, 3.0), wrench)->norm();
    sum += robot.kinetic_energy(motion) + robot.friction_power(motion);
  }
  EXPECT_EQ(counter.count(), 0);
  EXPECT_GT(sum, 0.0);
}

}  // namespace
}  // namespace flinch::testing
