#include "tests/systems/robot/mechanism_laws.h"
#include "systems/robot/decompositions.h"

#include <span>

#include "systems/robot/joint_space_dynamics.h"

// What holds for the motion of every mechanism, whatever its joints.
namespace flinch::test {
namespace {

class KinematicLaws : public MechanismLaws {
 protected:
  JointAngles joints_at(const Configuration& pose) const {
    return robot.inverse_kinematics(pose, robot.home_working_mode()).joints;
  }
  ForwardSolution forward(const JointVector& active, const Configuration& start) const {
    return robot.forward_kinematics(active, start, robot.home_working_mode());
  }
};
FLINCH_FOR_ALL_MECHANISMS(KinematicLaws);

TEST_P(KinematicLaws, ForwardKinematicsUndoesInverseKinematics) {
  Residual residual("pose, started 10 ms earlier", 3e-12);
  Residual iterations("iterations", 5);
  for (const auto& motion_state : states) {
    const auto& pose = motion_state.pose;
    const auto& velocity = motion_state.velocity;
    const Configuration earlier = space.plus(pose, -0.01 * velocity);
    const ForwardSolution solution = forward(joints_at(pose).active, earlier);
    ASSERT_TRUE(solution.converged);
    compare(residual, space.difference(solution.pose, pose), PlatformVector::Zero(n));
    iterations.add(solution.iterations);
  }
}

TEST_P(KinematicLaws, ForwardKinematicsWithoutAPoseOfTheSameBranchHasNotConverged) {
  int converged = 0;
  int not_converged = 0;
  for (const auto& motion_state : states) {
    const auto& pose = motion_state.pose;
    const auto& velocity = motion_state.velocity;
    const Configuration far = space.plus(pose, 6.0 * GetParam().region);
    for (const Configuration& start : {far, space.plus(pose, -3.0 * GetParam().region), robot.home_pose()}) {
      const ForwardSolution solution = forward(joints_at(pose).active, start);
      ASSERT_TRUE(space.contains(solution.pose));
      ASSERT_LE(solution.iterations, 10);
      ++(solution.converged ? converged : not_converged);
      if (!solution.converged) continue;
      const Kinematics found = kinematics_at(solution.pose, velocity);
      const JointVector error = robot.drive_difference(found.joints.active, joints_at(pose).active);
      EXPECT_LT(error.lpNorm<Eigen::Infinity>(), 1e-10);
      EXPECT_GT(found.det_A * kinematics_at(start, velocity).det_A, 0.0);
    }
  }
  EXPECT_GT(converged, 100);
  EXPECT_GT(not_converged, 0);
}

// Starts and poses from a wide region, which singularities divide.
TEST_P(KinematicLaws, ForwardKinematicsTellsAJumpToAnotherBranch) {
  MechanismCase wide = GetParam();
  wide.region *= 5.0;
  wide.least_det_A = 0.0;
  const std::vector<MotionState> wide_states = random_states(wide, 2000);
  const PlatformVector rest = PlatformVector::Zero(n);
  int jumps = 0;
  for (std::size_t i = 1; i < wide_states.size(); ++i) {
    const JointVector active = joints_at(wide_states[i].pose).active;
    const Configuration& start = wide_states[i - 1].pose;
    const ForwardSolution solution = forward(active, start);
    EXPECT_FALSE(solution.converged && solution.other_branch);
    if (!solution.converged && !solution.other_branch) continue;
    const Kinematics found = kinematics_at(solution.pose, rest);
    const JointVector error = robot.drive_difference(found.joints.active, active);
    const bool same_mode = error.lpNorm<Eigen::Infinity>() < GetParam().largest_disagreement;
    const bool same_assembly = found.det_A * kinematics_at(start, rest).det_A > 0.0;
    EXPECT_EQ(solution.converged, same_mode && same_assembly);
    jumps += solution.other_branch;
  }
  if (robot.drives() == n && GetParam().least_jumps > 0) {
    EXPECT_GE(jumps, GetParam().least_jumps);
  } else {
    EXPECT_EQ(jumps, 0) << "nothing leaves another pose";
  }
}

// Without passive encoders it is the home pose.
TEST_P(KinematicLaws, StartPoseOfExactAnglesIsThePose) {
  Residual residual("start pose [m, rad]", 1e-14);
  for (const auto& [drawn, velocity] : states) {
    const Configuration pose = robot.passive_joints() == 0 ? robot.home_pose() : drawn;
    const JointAngles joints = joints_at(drawn);
    const Configuration start = robot.start_pose(joints.active, joints.passive);
    compare(residual, space.difference(start, pose), PlatformVector::Zero(n));
    EXPECT_LT(robot.chain_closure_error(joints.active, joints.passive, pose), 1e-14);
    EXPECT_EQ(robot.working_mode(joints.passive), robot.home_working_mode());
  }
}

TEST_P(KinematicLaws, MapsToJointsAreTheDerivativesOfTheJoints) {
  Residual active("drive map", tolerances.drive_map);
  Residual passive("passive map", tolerances.drive_map);
  for (const auto& motion_state : states) {
    const auto& pose = motion_state.pose;
    const auto& velocity = motion_state.velocity;
    const Kinematics k = kinematics_at(pose, velocity);
    for (int axis = 0; axis < n; ++axis) {
      const auto moved = [&](double h) { return joints_at(space.plus(pose, h * unit(axis))); };
      const JointVector dq =
          derivative([&](double h) { return robot.drive_difference(moved(h).active, k.joints.active); },
                     tolerances.step);
      const JointVector dp = derivative(
          [&](double h) { return ParallelRobot::passive_difference(moved(h).passive, k.joints.passive); },
          tolerances.step);
      compare(active, k.J_qa_x.col(axis), dq);
      const JointVector dc = derivative(
          [&](double h) { return ParallelRobot::passive_difference(moved(h).coupling, k.joints.coupling); },
          tolerances.step);
      compare(passive, k.J_qp_x.col(axis), dp);
      compare(passive, k.J_qc_x.col(axis), dc);
    }
  }
}

TEST_P(KinematicLaws, RatesOfTheMapsAreTheirDerivativesAlongTheMotion) {
  Residual active("rate of the drive map", tolerances.drive_map_rate);
  Residual passive("rate of the passive map", tolerances.drive_map_rate);
  Residual inverse("rate of the inverse drive map", 10.0 * tolerances.drive_map_rate);
  for (const MotionState& state : states) {
    const Kinematics k = kinematics_after(state, 0.0);
    const auto rate = [&](PlatformMatrix Kinematics::*J) -> PlatformMatrix {
      return derivative([&](double h) -> PlatformMatrix { return kinematics_after(state, h).*J; },
                        tolerances.step);
    };
    compare(active, k.dJ_qa_x, rate(&Kinematics::J_qa_x));
    compare(passive, k.dJ_qp_x, rate(&Kinematics::J_qp_x));
    compare(passive, k.dJ_qc_x, rate(&Kinematics::J_qc_x));
    compare(inverse, k.dJ_x_qa, rate(&Kinematics::J_x_qa));
  }
}

TEST_P(KinematicLaws, RatesInverseAndConditionFollowFromTheDriveMap) {
  Residual rates("joint rates", 3e-14);
  Residual inverse("J_x,qa J_qa,x = I", 1e-13);
  Residual condition("sigma_kappa against singular values, relative", 1e-11);
  PlatformVector scale = PlatformVector::Ones(n);
  scale.tail(space.rotations()).setConstant(1.0 / robot.description().characteristic_length);
  for (const auto& motion_state : states) {
    const auto& pose = motion_state.pose;
    const auto& velocity = motion_state.velocity;
    const Kinematics k = kinematics_at(pose, velocity);
    compare(rates, k.rates.active, PlatformVector(k.J_qa_x * velocity));
    compare(rates, k.rates.passive, PlatformVector(k.J_qp_x * velocity));
    compare(inverse, PlatformMatrix(k.J_x_qa * k.J_qa_x), PlatformMatrix::Identity(n, n));
    const Eigen::MatrixXd A = k.J_qa_x * scale.asDiagonal();
    const Eigen::VectorXd values = A.jacobiSvd().singularValues();
    condition.add(k.sigma_kappa * values[n - 1] / values[0] - 1.0);
  }
}

TEST_P(KinematicLaws, PlatformVelocityFollowsFromTheRatesOfTheDrives) {
  Residual residual("velocity from drive rates", 1e-13);
  const WorkingMode mode = robot.home_working_mode();
  for (const auto& [pose, velocity] : states) {
    const Kinematics k = kinematics_at(pose, velocity);
    const auto found = robot.platform_velocity(pose, k.rates.active, mode);
    ASSERT_TRUE(found.has_value());
    compare(residual, *found, velocity);
    const Configuration far = space.plus(pose, PlatformVector::Constant(n, 9.0));
    EXPECT_FALSE(robot.platform_velocity(far, k.rates.active, mode).has_value());
    EXPECT_FALSE(robot.platform_velocity(pose, JointVector(), mode).has_value());
  }
}

TEST_P(KinematicLaws, ContactJacobiansAreTheDerivativesOfPoints) {
  Residual translation("points of all bodies", tolerances.contact);
  Residual rotation("axes of all bodies", tolerances.contact);
  for (const auto& motion_state : std::span(states).first(100)) {
    const auto& pose = motion_state.pose;
    const auto& velocity = motion_state.velocity;
    const Kinematics k = kinematics_at(pose, velocity);
    for (const auto& place : points()) {
      const BodyId body = place.first;
      const CartesianVector& point = place.second;
      const ContactJacobian contact = robot.contact_jacobian(k, body, point);
      ASSERT_TRUE(contact.valid);
      for (int axis = 0; axis < n; ++axis) {
        const auto at = [&](double h, const CartesianVector& p) {
          return robot.point_on_body(kinematics_at(space.plus(pose, h * unit(axis)), velocity), body, p);
        };
        const CartesianVector column = derivative([&](double h) { return at(h, point); }, tolerances.step);
        compare(translation, contact.translation.col(axis), column);
        // Along its x axis and, in space, its y axis: how the body turns.
        for (int direction = 0; direction < robot.space_dimension() - 1; ++direction) {
          const CartesianVector unit_point = CartesianVector::Unit(robot.space_dimension(), direction);
          const CartesianVector zero = CartesianVector::Zero(robot.space_dimension());
          const auto arm = [&](double h) -> CartesianVector { return at(h, unit_point) - at(h, zero); };
          compare(rotation, turned(contact.rotation.col(axis), arm(0.0)), derivative(arm, tolerances.step));
        }
      }
    }
  }
}

TEST_P(KinematicLaws, RatesOfContactJacobiansAreTheirDerivativesAlongTheMotion) {
  Residual translation("points of all bodies", tolerances.contact_rate);
  Residual rotation("axes of all bodies", tolerances.contact_rate);
  Residual joints("from drives", 20.0 * tolerances.contact_rate);
  for (const MotionState& state : std::span(states).first(100)) {
    for (const auto& place : points()) {
      const BodyId body = place.first;
      const CartesianVector& point = place.second;
      const auto at = [&](double h) {
        return robot.contact_jacobian(kinematics_after(state, h), body, point);
      };
      const auto from_drives = [&](double h) {
        return from_active_joints(at(h), kinematics_after(state, h));
      };
      const ContactJacobian contact = at(0.0);
      const auto rate = [&](auto f) { return derivative(f, tolerances.step); };
      compare(translation, contact.d_translation, rate([&](double h) { return at(h).translation; }));
      compare(rotation, contact.d_rotation, rate([&](double h) { return at(h).rotation; }));
      compare(joints, from_drives(0.0).d_translation,
              rate([&](double h) { return from_drives(h).translation; }));
    }
  }
}

TEST_P(KinematicLaws, ForcesDoTheSameWorkOnEveryWay) {
  Residual contact_power("power of forces on bodies [W]", 1e-12);
  Residual drive_power("power of wrenches by drives [W]", 1e-11);
  Residual round_trip("wrench to drives and back", 1e-12);
  const CartesianVector force = Eigen::Vector3d(30.0, -40.0, 20.0).head(robot.space_dimension());
  for (const auto& motion_state : states) {
    const auto& pose = motion_state.pose;
    const auto& velocity = motion_state.velocity;
    const Kinematics k = kinematics_at(pose, velocity);
    for (const auto& place : points()) {
      const BodyId body = place.first;
      const CartesianVector& point = place.second;
      const ContactJacobian contact = robot.contact_jacobian(k, body, point);
      const PlatformVector wrench = platform_wrench(contact, force);
      const double power = force.dot(contact.translation * velocity);
      contact_power.add((wrench.dot(velocity) - power) / std::max(1.0, std::abs(power)));
      drive_power.add((drive_torques(k, wrench).dot(k.rates.active) - power) /
                      std::max(1.0, std::abs(power)));
      compare(round_trip, platform_wrench(k, drive_torques(k, wrench)), wrench);
    }
  }
}

TEST_P(KinematicLaws, LegsJoinBaseAndPlatform) {
  Residual residual("leg points are points of the links [m]", 1e-14);
  for (const auto& motion_state : states) {
    const auto& pose = motion_state.pose;
    const auto& velocity = motion_state.velocity;
    const Kinematics k = kinematics_at(pose, velocity);
    for (int i = 0; i < robot.legs(); ++i) {
      const LegPoints& leg = k.legs[static_cast<std::size_t>(i)];
      const BodyId first = BodyId::link1(i);
      const BodyId second = BodyId::link2(i);
      compare(residual, robot.point_on_body(k, first, robot.axis_point(first, 0.0)), leg.base_joint);
      compare(residual, robot.point_on_body(k, first, robot.axis_point(first, 1.0)), leg.passive_joint);
      compare(residual, robot.point_on_body(k, second, robot.axis_point(second, 1.0)), leg.coupling_joint);
    }
  }
}

}  // namespace
}  // namespace flinch::test
