#pragma once

#include <Eigen/Geometry>
#include <algorithm>

#include "systems/robot/contact_jacobian.h"
#include "tests/systems/robot/differences.h"
#include "tests/systems/robot/mechanism_cases.h"
#include "tests/systems/robot/random_states.h"
#include "tests/systems/robot/residual.h"

namespace flinch::test {

/// What the suites of laws have in common: a mechanism and 300 of its states.
class MechanismLaws : public ::testing::TestWithParam<MechanismCase> {
 protected:
  const ParallelRobot& robot = *GetParam().robot;
  const ConfigurationSpace space = robot.space();
  const int n = robot.dof();
  const std::vector<MotionState> states = random_states(GetParam(), 300);
  const Tolerances& tolerances = GetParam().tolerances;

  Kinematics kinematics_at(const Configuration& pose, const PlatformVector& velocity) const {
    Kinematics k;
    robot.kinematics(pose, velocity, k);
    return k;
  }
  /// At pose (+) velocity h: along the motion.
  Kinematics kinematics_after(const MotionState& state, double h) const {
    return kinematics_at(space.plus(state.pose, state.velocity * h), state.velocity);
  }
  Dynamics dynamics_of(const Kinematics& k) const {
    Dynamics dynamics;
    robot.dynamics(k, dynamics);
    return dynamics;
  }
  PlatformVector unit(int axis) const { return PlatformVector::Unit(n, axis); }

  /// Points beside the axes of all bodies, each with its body.
  std::vector<std::pair<BodyId, CartesianVector>> points() const {
    std::vector<std::pair<BodyId, CartesianVector>> points;
    const Eigen::Vector3d beside(0.07, -0.04, 0.11);
    for (int i = 0; i < robot.body_count(); ++i) {
      const BodyId body = BodyId::from_index(i);
      const CartesianVector offset = beside.head(robot.space_dimension());
      points.emplace_back(body, robot.axis_point(body, 0.6) + offset);
    }
    return points;
  }

  /// omega x r: `omega` has one entry in the plane.
  static CartesianVector turned(const CartesianVector& omega, const CartesianVector& r) {
    if (r.size() == 2) return Eigen::Vector2d(-omega[0] * r[1], omega[0] * r[0]);
    return omega.head<3>().cross(r.head<3>());
  }
  /// A residual counts relative to its scale where that is above 1.
  template <class A, class B>
  static void compare(Residual& residual, const A& a, const B& b) {
    ASSERT_EQ(a.rows(), b.rows());
    ASSERT_EQ(a.cols(), b.cols());
    if (a.size() == 0) return residual.add(0.0);
    const double scale = std::max(1.0, b.template lpNorm<Eigen::Infinity>());
    residual.add((a - b).template lpNorm<Eigen::Infinity>() / scale);
  }
};

}  // namespace flinch::test

#define FLINCH_FOR_ALL_MECHANISMS(suite) \
  INSTANTIATE_TEST_SUITE_P(All, suite, ::testing::ValuesIn(mechanism_cases()), case_name)
