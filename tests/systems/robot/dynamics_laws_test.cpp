#include "systems/robot/forward_dynamics.h"

#include <Eigen/Dense>
#include <span>

#include "systems/robot/joint_space_dynamics.h"
#include "systems/robot/robot_deviation.h"
#include "tests/systems/robot/mechanism_laws.h"

// What holds for the equations of motion of every mechanism.
namespace flinch::test {
namespace {

class DynamicLaws : public MechanismLaws {
 protected:
  Dynamics dynamics_at(const Configuration& pose, const PlatformVector& velocity) const {
    return dynamics_of(kinematics_at(pose, velocity));
  }
  Dynamics dynamics_after(const MotionState& state, double h) const {
    return dynamics_of(kinematics_after(state, h));
  }
  double energy(const Configuration& pose, const PlatformVector& velocity) const {
    const Kinematics k = kinematics_at(pose, velocity);
    return kinetic_energy(k, dynamics_of(k));
  }
  double potential(const Configuration& pose) const {
    const Kinematics k = kinematics_at(pose, PlatformVector::Zero(n));
    const int directions = robot.space_dimension();
    double sum = 0.0;
    for (int i = 0; i < robot.body_count(); ++i) {
      const RigidBodyInertia& body = GetParam().bodies[static_cast<std::size_t>(i)];
      const CartesianVector centre = body.centre_of_mass.head(directions);
      sum -= body.mass *
             robot.gravity().head(directions).dot(robot.point_on_body(k, BodyId::from_index(i), centre));
    }
    return sum;
  }
  // Loads of every kind, different for every drive, coordinate and body.
  Loads loads_at(const Kinematics& k) const {
    Loads loads{JointVector(robot.drives()), PlatformVector(n), {}};
    for (int i = 0; i < robot.drives(); ++i) loads.drives[i] = 4.0 - 3.0 * i + 0.7 * i * i;
    for (int i = 0; i < n; ++i) loads.wrench[i] = 5.0 - 2.0 * i;
    for (const auto& [body, point] : points()) {
      Push push{body, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
      const CartesianVector at = robot.point_on_body(k, body, point);
      const Eigen::Vector3d force(3.0 + body.index(), 2.0 - body.index(), 1.0 + 0.5 * body.index());
      push.point.head(at.size()) = at;
      push.force.head(at.size()) = force.head(at.size());
      loads.pushes.push_back(push);
    }
    return loads;
  }
  PlatformVector wrench_of(const Kinematics& k, const Loads& loads) const {
    PlatformVector wrench = loads.wrench;
    const auto all_points = points();
    for (std::size_t i = 0; i < loads.pushes.size(); ++i) {
      const auto& [body, point] = all_points[i];
      const CartesianVector force = loads.pushes[i].force.head(robot.space_dimension());
      wrench += platform_wrench(robot.contact_jacobian(k, body, point), force);
    }
    return wrench;
  }
};
FLINCH_FOR_ALL_MECHANISMS(DynamicLaws);

TEST_P(DynamicLaws, MassMatrixIsTheSumOverAllBodies) {
  if (GetParam().bodies.empty()) GTEST_SKIP() << "the case has no bodies";
  Residual residual("M against the sum over bodies", 1e-13);
  const int directions = robot.space_dimension();
  const int axes = directions == 3 ? 3 : 1;
  for (const auto& [pose, velocity] : states) {
    const Kinematics k = kinematics_at(pose, velocity);
    double twice_energy = 0.0;
    for (int i = 0; i < robot.body_count(); ++i) {
      const RigidBodyInertia& body = GetParam().bodies[static_cast<std::size_t>(i)];
      const BodyId id = BodyId::from_index(i);
      const CartesianVector centre = body.centre_of_mass.head(directions);
      const ContactJacobian J = robot.contact_jacobian(k, id, centre);
      const CartesianVector v = J.translation * velocity;
      const CartesianVector omega = J.rotation * velocity;
      twice_energy += body.mass * v.squaredNorm();
      if (axes == 1) {
        twice_energy += body.inertia(2, 2) * omega.squaredNorm();
        continue;
      }
      Eigen::Matrix3d R;
      const CartesianVector origin = robot.point_on_body(k, id, Eigen::Vector3d::Zero());
      for (int axis = 0; axis < 3; ++axis) {
        R.col(axis) = robot.point_on_body(k, id, Eigen::Vector3d::Unit(axis)) - origin;
      }
      const Eigen::Vector3d in_body = R.transpose() * omega;
      twice_energy += in_body.dot(body.inertia * in_body);
    }
    twice_energy += GetParam().armature * k.rates.active.squaredNorm();
    const double expected = 0.5 * twice_energy;
    residual.add((energy(pose, velocity) - expected) / std::max(1.0, expected));
  }
}

TEST_P(DynamicLaws, MassMatrixIsSymmetricAndPositiveDefinite) {
  Residual asymmetry("asymmetry of M", 1e-14);
  for (const auto& [pose, velocity] : states) {
    const PlatformMatrix M = dynamics_at(pose, velocity).M_x;
    compare(asymmetry, M, PlatformMatrix(M.transpose()));
    EXPECT_EQ(Eigen::MatrixXd(M).llt().info(), Eigen::Success);
  }
}

TEST_P(DynamicLaws, MassMatrixChangesByCoriolisMatrixPlusItsTranspose) {
  Residual residual("dM/dt = C + C^T", tolerances.mass_rate);
  for (const MotionState& state : states) {
    const PlatformMatrix C = dynamics_after(state, 0.0).C_x;
    const auto M = [&](double h) { return dynamics_after(state, h).M_x; };
    compare(residual, PlatformMatrix(C + C.transpose()), derivative(M, tolerances.step));
  }
}

// C^T v = d(v^T M v / 2)/dx at fixed v, and for rotations in space the moment omega x p_omega of Hamel.
TEST_P(DynamicLaws, TransposedCoriolisMatrixTimesVelocityIsTheDerivativeOfTheKineticEnergy) {
  Residual residual("C^T v against the kinetic energy", tolerances.momentum);
  for (const auto& state : states) {
    const auto& pose = state.pose;
    const auto& velocity = state.velocity;
    const Dynamics dynamics = dynamics_at(pose, velocity);
    PlatformVector expected(n);
    for (int axis = 0; axis < n; ++axis) {
      expected[axis] = derivative(
          [&](double h) { return energy(space.plus(pose, h * unit(axis)), velocity); }, tolerances.step);
    }
    if (space.rotations() == 3) {
      const Eigen::Vector3d p_omega = (dynamics.M_x * velocity).tail<3>();
      expected.tail<3>() += velocity.tail<3>().cross(p_omega);
    }
    compare(residual, PlatformVector(dynamics.C_x.transpose() * velocity), expected);
  }
}

TEST_P(DynamicLaws, GravityIsTheDerivativeOfThePotential) {
  if (GetParam().bodies.empty()) GTEST_SKIP() << "the case has no bodies";
  Residual residual("g against the potential", tolerances.gravity);
  for (const auto& state : states) {
    const auto& pose = state.pose;
    PlatformVector expected(n);
    for (int axis = 0; axis < n; ++axis) {
      expected[axis] =
          derivative([&](double h) { return potential(space.plus(pose, h * unit(axis))); }, 1e-3);
    }
    compare(residual, dynamics_at(pose, state.velocity).g_x, expected);
  }
}

TEST_P(DynamicLaws, AccelerationIsThatOfBodiesHeldTogetherByConstraintForces) {
  if (!GetParam().reference) GTEST_SKIP() << "the case has no reference";
  Residual residual("acceleration against maximal coordinates, relative", tolerances.acceleration);
  for (const MotionState& state : states) {
    const Kinematics k = kinematics_after(state, 0.0);
    const Loads loads = loads_at(k);
    const auto acceleration = forward_dynamics(k, dynamics_of(k), loads.drives, wrench_of(k, loads));
    ASSERT_TRUE(acceleration.has_value());
    const PlatformVector reference = GetParam().reference(state, loads);
    residual.add((*acceleration - reference).norm() / reference.norm());
  }
}

TEST_P(DynamicLaws, EquationsOfMotionAreThoseOfKinematicsAndDynamics) {
  Residual mass("M of both", 1e-13);
  Residual rest("h against C v + g + F_fr", 1e-12);
  Residual acceleration("acceleration from both, relative", 1e-11);
  for (const MotionState& state : states) {
    const Kinematics k = kinematics_at(state.pose, state.velocity);
    const Dynamics dynamics = dynamics_of(k);
    Kinematics moving;
    MotionEquations equations;
    robot.equations_of_motion(state.pose, state.velocity, moving, equations);
    ASSERT_TRUE(equations.valid && moving.reachable);
    EXPECT_EQ(moving.joints.active, k.joints.active);
    EXPECT_EQ(moving.rates.active, k.rates.active);
    EXPECT_EQ(moving.J_qa_x, k.J_qa_x);
    compare(mass, equations.M_x, dynamics.M_x);
    compare(rest, equations.h_x,
            PlatformVector(dynamics.C_x * state.velocity + dynamics.g_x + dynamics.F_fr_x));
    const Loads loads = loads_at(k);
    const PlatformVector direct = *forward_dynamics(k, dynamics, loads.drives, loads.wrench);
    const auto found = forward_dynamics(moving, equations, loads.drives, loads.wrench);
    ASSERT_TRUE(found.has_value());
    acceleration.add((*found - direct).norm() / direct.norm());
    EXPECT_NEAR(kinetic_energy(moving, equations), kinetic_energy(k, dynamics), 1e-12);
  }
}

TEST_P(DynamicLaws, DrivesAccelerateAsTheRatesOfTheirMapAndThePlatformSay) {
  Residual residual("drive acceleration, relative", tolerances.acceleration);
  for (const MotionState& state : states) {
    const Kinematics k = kinematics_at(state.pose, state.velocity);
    JointVector efforts(robot.drives());
    for (int i = 0; i < robot.drives(); ++i) efforts[i] = 4.0 - 3.0 * i + 0.7 * i * i;
    const auto dv = forward_dynamics(k, dynamics_of(k), efforts, PlatformVector::Zero(n));
    const auto found = robot.drive_acceleration(state.pose, state.velocity, efforts);
    ASSERT_TRUE(dv && found);
    compare(residual, *found, JointVector(k.J_qa_x * *dv + k.dJ_qa_x * state.velocity));
  }
}

TEST_P(DynamicLaws, MomentumChangesByForcesAndTransposedCoriolisMatrix) {
  if (!GetParam().reference) GTEST_SKIP() << "the case has no reference";
  Residual residual("d(M v)/dt = A^T tau + F - g - F_fr + C^T v", 10.0 * tolerances.momentum);
  for (const MotionState& state : std::span(states).first(100)) {
    const Kinematics k = kinematics_after(state, 0.0);
    const Dynamics dynamics = dynamics_of(k);
    const Loads loads = loads_at(k);
    const PlatformVector acceleration = GetParam().reference(state, loads);
    const auto momentum = [&](double h) -> PlatformVector {
      const PlatformVector xi = h * state.velocity + 0.5 * h * h * acceleration;
      const PlatformVector v = state.velocity + h * acceleration;
      return dynamics_at(space.plus(state.pose, xi), v).M_x * v;
    };
    const PlatformVector rate = platform_wrench(k, loads.drives) + wrench_of(k, loads) - dynamics.g_x -
                                dynamics.F_fr_x + dynamics.C_x.transpose() * state.velocity;
    compare(residual, derivative(momentum, 1e-5), rate);
  }
}

TEST_P(DynamicLaws, FrictionTakesPower) {
  for (const auto& [pose, velocity] : states) {
    const Kinematics k = kinematics_at(pose, velocity);
    EXPECT_GE(friction_power(k, dynamics_of(k)), 0.0);
    const Kinematics at_rest = kinematics_at(pose, PlatformVector::Zero(n));
    EXPECT_EQ(friction_power(at_rest, dynamics_of(at_rest)), 0.0);
  }
}

/// Viscous friction is gone from d(2 v) - 2 d(v), where d is what drives without friction would lack.
TEST_P(DynamicLaws, DryFrictionOfDrivesIsTheirShareOfAllFriction) {
  const auto without = robot.deviating({.drive_friction_scale = JointVector::Zero(robot.drives())});
  if (without == nullptr) GTEST_SKIP() << "cannot differ from itself";
  Residual residual("dry friction of drives", 1e-11);
  const auto lacks = [&](const MotionState& state, double times) -> PlatformVector {
    Kinematics k;
    Dynamics other;
    without->kinematics(state.pose, times * state.velocity, k);
    without->dynamics(k, other);
    return dynamics_at(state.pose, times * state.velocity).F_fr_x - other.F_fr_x;
  };
  for (const MotionState& state : std::span(states).first(100)) {
    const Kinematics k = kinematics_at(state.pose, state.velocity);
    JointVector efforts(robot.drives());
    for (int i = 0; i < robot.drives(); ++i) {
      const DryFriction friction = robot.dry_friction(i);
      efforts[i] = friction.at(2.0 * k.rates.active[i]) - 2.0 * friction.at(k.rates.active[i]);
    }
    compare(residual, PlatformVector(lacks(state, 2.0) - 2.0 * lacks(state, 1.0)),
            platform_wrench(k, efforts));
  }
}

TEST_P(DynamicLaws, JointSpaceFormHasTheSameSolution) {
  Residual acceleration("accelerations from both forms, relative", 1e-11);
  Residual passivity("dM_qa/dt = C_qa + C_qa^T", 5e-9);
  for (const MotionState& state : states) {
    const Kinematics k = kinematics_after(state, 0.0);
    const Dynamics dynamics = dynamics_of(k);
    const JointSpaceDynamics joints = joint_space_dynamics(k, dynamics);
    ASSERT_TRUE(joints.valid);
    const JointVector efforts = loads_at(k).drives;
    const JointVector bias = joints.C_qa * k.rates.active + joints.g_qa + joints.tau_fr_qa;
    // M_qa is singular where there are more drives than coordinates.
    const JointVector ddq =
        Eigen::MatrixXd(joints.M_qa).completeOrthogonalDecomposition().solve(Eigen::VectorXd(efforts - bias));
    const PlatformVector from_joints = k.J_x_qa * ddq + k.dJ_x_qa * k.rates.active;
    const PlatformVector direct = *forward_dynamics(k, dynamics, efforts, PlatformVector::Zero(n));
    acceleration.add((from_joints - direct).norm() / direct.norm());
    const auto M = [&](double h) {
      const Kinematics after = kinematics_after(state, h);
      return joint_space_dynamics(after, dynamics_of(after)).M_qa;
    };
    compare(passivity, PlatformMatrix(joints.C_qa + joints.C_qa.transpose()), derivative(M, tolerances.step));
  }
}

}  // namespace
}  // namespace flinch::test
