#include <cmath>
#include <limits>

#include "systems/robot/forward_dynamics.h"
#include "systems/robot/joint_space_dynamics.h"
#include "systems/robot/link_segments.h"
#include "tests/support/allocations.h"
#include "tests/systems/robot/mechanism_laws.h"

// Whatever a mechanism is asked, it answers with finite numbers, says whether they mean anything, and
// allocates nothing.
namespace flinch::test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

class UnusableInput : public MechanismLaws {
 protected:
  // Spoilt copies of `good`: one entry each that is none, infinite or huge, and wrong sizes.
  template <class Vector>
  static std::vector<Vector> spoilt(const Vector& good) {
    std::vector<Vector> all = {Vector()};
    if (good.size() > 1) all.push_back(good.head(good.size() - 1));
    for (const double bad : {nan, infinity, -infinity, 1e154, -1e200, 1e308}) {
      for (int i = 0; i < good.size(); ++i) {
        all.push_back(good);
        all.back()[i] = bad;
      }
    }
    return all;
  }

  // Everything that hangs on a kinematics, however it came about.
  void expect_finite(const Kinematics& k) const {
    for (const PlatformMatrix* J :
         {&k.J_qa_x, &k.J_qp_x, &k.J_qc_x, &k.J_x_qa, &k.dJ_qa_x, &k.dJ_qp_x, &k.dJ_qc_x, &k.dJ_x_qa}) {
      EXPECT_TRUE(J->allFinite());
    }
    EXPECT_EQ(k.J_qa_x.rows(), robot.drives());
    EXPECT_EQ(k.J_qa_x.cols(), n);
    EXPECT_EQ(k.J_x_qa.rows(), n);
    EXPECT_EQ(k.J_qp_x.rows(), robot.passive_joints());
    EXPECT_TRUE(space.contains(k.pose));
    EXPECT_TRUE(k.velocity.size() == n && k.velocity.allFinite());
    EXPECT_TRUE(k.joints.active.allFinite() && k.rates.active.allFinite() && k.rates.passive.allFinite());
    EXPECT_TRUE(std::isfinite(k.det_A) && std::isfinite(k.det_B) && !std::isnan(k.sigma_kappa));
    for (const LegPoints& leg : k.legs) {
      EXPECT_TRUE(leg.base_joint.allFinite() && leg.passive_joint.allFinite() &&
                  leg.coupling_joint.allFinite());
    }
    const Dynamics dynamics = dynamics_of(k);
    EXPECT_EQ(dynamics.valid, k.reachable);
    EXPECT_EQ(dynamics.M_x.rows(), n);
    EXPECT_TRUE(dynamics.M_x.allFinite() && dynamics.C_x.allFinite() && dynamics.g_x.allFinite() &&
                dynamics.F_fr_x.allFinite());
    EXPECT_TRUE(std::isfinite(self_collision_distance(robot, k)));
    EXPECT_EQ(joint_space_dynamics(k, dynamics).valid, k.valid);
    EXPECT_TRUE(joint_space_dynamics(k, dynamics).M_qa.allFinite());
    for (const auto& [body, point] : points()) {
      const ContactJacobian contact = robot.contact_jacobian(k, body, point);
      EXPECT_EQ(contact.valid, k.reachable);
      EXPECT_TRUE(contact.translation.allFinite() && contact.d_translation.allFinite());
      EXPECT_EQ(contact.translation.rows(), robot.space_dimension());
      EXPECT_EQ(contact.translation.cols(), n);
    }
  }

  const Configuration home = robot.home_pose();
  const PlatformVector still = PlatformVector::Zero(n);
  const WorkingMode mode = robot.home_working_mode();
};
FLINCH_FOR_ALL_MECHANISMS(UnusableInput);

TEST_P(UnusableInput, OfAPoseIsUnreachable) {
  for (const Configuration& pose : spoilt(home)) {
    const Kinematics k = kinematics_at(pose, GetParam().velocity);
    EXPECT_FALSE(k.reachable || k.valid) << pose.transpose();
    EXPECT_TRUE(k.J_qa_x.isZero(0.0) && k.sigma_kappa == infinity);
    expect_finite(k);
    const InverseSolution solution = robot.inverse_kinematics(pose, mode);
    EXPECT_FALSE(solution.reachable) << pose.transpose();
    EXPECT_EQ(solution.joints.active.size(), robot.drives());
    EXPECT_TRUE(solution.joints.active.isZero(0.0));
  }
}

TEST_P(UnusableInput, OfAVelocityIsUnreachable) {
  for (const PlatformVector& velocity : spoilt(GetParam().velocity)) {
    const Kinematics k = kinematics_at(home, velocity);
    EXPECT_FALSE(k.reachable || k.valid) << velocity.transpose();
    expect_finite(k);
  }
}

TEST_P(UnusableInput, EndsWhereAMachineEnds) {
  const PlatformVector fast = GetParam().velocity * (1e9 / GetParam().velocity.maxCoeff());
  const Kinematics k = kinematics_at(home, fast);
  EXPECT_TRUE(k.reachable && k.valid);
  expect_finite(k);
  for (const MotionState& state : random_states(GetParam(), 50, 3)) {
    expect_finite(kinematics_at(space.plus(state.pose, 3.0 * GetParam().region), fast));
  }
}

TEST_P(UnusableInput, OfForwardKinematicsHasNotConverged) {
  const JointVector active = robot.inverse_kinematics(home, mode).joints.active;
  const auto expect_not_converged = [&](const JointVector& q, const Configuration& start,
                                        const WorkingMode& in) {
    const ForwardSolution solution = robot.forward_kinematics(q, start, in);
    EXPECT_FALSE(solution.converged) << q.transpose() << " from " << start.transpose();
    EXPECT_TRUE(space.contains(solution.pose));
  };
  EXPECT_TRUE(robot.forward_kinematics(active, home, mode).converged);
  for (const JointVector& q : spoilt(active)) expect_not_converged(q, home, mode);
  for (const Configuration& start : spoilt(home)) expect_not_converged(active, start, mode);
  expect_not_converged(active, home, WorkingMode());
  expect_not_converged(active, home, WorkingMode::Constant(robot.legs(), 2));
  expect_not_converged(active, home, WorkingMode::Constant(robot.legs(), -1));
  EXPECT_FALSE(robot.inverse_kinematics(home, WorkingMode::Constant(robot.legs(), 2)).reachable);
}

TEST_P(UnusableInput, OfEncodersGivesTheHomePoseAndAnInfiniteError) {
  const JointAngles joints = robot.inverse_kinematics(home, mode).joints;
  for (const JointVector& q : spoilt(joints.active)) {
    EXPECT_EQ(robot.start_pose(q, joints.passive), home);
    EXPECT_EQ(robot.chain_closure_error(q, joints.passive, home), infinity);
  }
  if (robot.passive_joints() == 0) return;
  for (const JointVector& q : spoilt(joints.passive)) {
    EXPECT_EQ(robot.start_pose(joints.active, q), home);
    EXPECT_EQ(robot.chain_closure_error(joints.active, q, home), infinity);
    EXPECT_EQ(robot.working_mode(q), mode);
  }
}

TEST_P(UnusableInput, OfAPointGivesAnInvalidContact) {
  const Kinematics k = kinematics_at(home, still);
  const CartesianVector point = robot.axis_point(BodyId::link1(0), 0.5);
  for (const CartesianVector& bad : spoilt(point)) {
    EXPECT_FALSE(robot.contact_jacobian(k, BodyId::link1(0), bad).valid);
    EXPECT_TRUE(robot.point_on_body(k, BodyId::link1(0), bad).isZero(0.0));
  }
  for (const BodyId body : {BodyId::from_index(robot.body_count()), BodyId::from_index(-1)}) {
    EXPECT_FALSE(robot.contact_jacobian(k, body, point).valid);
  }
  const ContactJacobian nothing = robot.contact_jacobian(Kinematics(), BodyId::platform(), point);
  EXPECT_FALSE(nothing.valid);
  EXPECT_TRUE(nothing.translation.isZero(0.0));
}

TEST_P(UnusableInput, OfForwardDynamicsHasNoResult) {
  const Kinematics k = kinematics_at(home, still);
  const Dynamics dynamics = dynamics_of(k);
  const JointVector efforts = JointVector::Zero(robot.drives());
  EXPECT_TRUE(forward_dynamics(k, dynamics, efforts, still).has_value());
  EXPECT_FALSE(forward_dynamics(Kinematics(), dynamics, efforts, still).has_value());
  EXPECT_FALSE(forward_dynamics(k, Dynamics(), efforts, still).has_value());
  EXPECT_FALSE(forward_dynamics(k, dynamics, JointVector(), still).has_value());
  EXPECT_FALSE(forward_dynamics(k, dynamics, efforts, PlatformVector()).has_value());
  EXPECT_FALSE(forward_dynamics(k, dynamics, efforts, PlatformVector::Constant(n, nan)).has_value());
}

TEST_P(UnusableInput, OfEquationsOfMotionMakesThemInvalid) {
  Kinematics k;
  MotionEquations equations;
  const auto are_valid = [&](const Configuration& pose, const PlatformVector& velocity) {
    robot.equations_of_motion(pose, velocity, k, equations);
    expect_finite(k);
    EXPECT_EQ(equations.valid, k.reachable);
    return equations.valid;
  };
  EXPECT_TRUE(are_valid(home, still));
  for (const Configuration& pose : spoilt(home)) EXPECT_FALSE(are_valid(pose, still)) << pose.transpose();
  for (const PlatformVector& v : spoilt(GetParam().velocity)) EXPECT_FALSE(are_valid(home, v));
  EXPECT_FALSE(are_valid(space.plus(home, PlatformVector::Constant(n, 9.0)), still)) << "out of reach";
  const AllocationCounter counter;
  robot.equations_of_motion(home, still, k, equations);
  EXPECT_EQ(counter.count(), 0);
}

TEST_P(UnusableInput, OfDriveAccelerationHasNoResult) {
  const JointVector efforts = JointVector::Zero(robot.drives());
  EXPECT_TRUE(robot.drive_acceleration(home, still, efforts).has_value());
  EXPECT_FALSE(robot.drive_acceleration(Configuration(), still, efforts).has_value());
  EXPECT_FALSE(robot.drive_acceleration(home, PlatformVector(), efforts).has_value());
  EXPECT_FALSE(robot.drive_acceleration(home, still, JointVector()).has_value());
  EXPECT_FALSE(robot.drive_acceleration(home, PlatformVector::Constant(n, nan), efforts).has_value());
  EXPECT_FALSE(robot.drive_acceleration(home, still, JointVector::Constant(robot.drives(), nan)).has_value());
}

TEST_P(UnusableInput, NeitherItNorGoodInputAllocates) {
  const std::vector<Configuration> bad = spoilt(home);
  const auto all_points = points();
  const test::AllocationCounter counter;
  const auto evaluate = [&](const Configuration& pose, const PlatformVector& velocity) {
    const Kinematics k = kinematics_at(pose, velocity);
    const Dynamics dynamics = dynamics_of(k);
    robot.start_pose(k.joints.active, k.joints.passive);
    const ForwardSolution found = robot.forward_kinematics(k.joints.active, home, mode);
    robot.inverse_kinematics(found.pose, mode);
    robot.chain_closure_error(k.joints.active, k.joints.passive, found.pose);
    self_collision_distance(robot, k);
    joint_space_dynamics(k, dynamics);
    forward_dynamics(k, dynamics, k.joints.active, velocity);
    for (const auto& [body, point] : all_points) {
      const ContactJacobian contact = robot.contact_jacobian(k, body, point);
      const CartesianVector force = robot.point_on_body(k, body, point);
      platform_wrench(k, drive_torques(k, clamping_wrench(contact, force, contact, force)));
      from_active_joints(contact, k);
    }
  };
  for (const MotionState& state : states) evaluate(state.pose, state.velocity);
  for (const Configuration& pose : bad) evaluate(pose, still);
  EXPECT_EQ(counter.count(), 0);
}

}  // namespace
}  // namespace flinch::test
