#include "systems/robot/robot_deviation.h"

#include "systems/foundation/setup_error.h"
#include "systems/robot/forward_dynamics.h"
#include "tests/systems/robot/mechanism_laws.h"

namespace flinch::test {
namespace {

class DeviationLaws : public MechanismLaws {
 protected:
  Dynamics dynamics_with(const RobotDeviation& deviation, const Kinematics& k) const {
    Dynamics dynamics;
    true_robot(GetParam().robot, deviation)->dynamics(k, dynamics);
    return dynamics;
  }
  double energy_with(const RobotDeviation& deviation, const Kinematics& k) const {
    return kinetic_energy(k, dynamics_with(deviation, k));
  }
  JointVector of_each_leg(double value) const { return JointVector::Constant(robot.legs(), value); }
};
FLINCH_FOR_ALL_MECHANISMS(DeviationLaws);

TEST_P(DeviationLaws, WithoutAnyItIsTheRobotItself) {
  EXPECT_EQ(true_robot(GetParam().robot, {}), GetParam().robot);
  EXPECT_EQ(true_robot(GetParam().robot, {.leg_inertia_scale = of_each_leg(1.0)}), GetParam().robot);
}

TEST_P(DeviationLaws, APayloadMovesWithThePlatform) {
  Residual residual("kinetic energy of a payload, relative", 1e-12);
  constexpr double payload = 1.7;  // [kg]
  for (const MotionState& state : states) {
    const Kinematics k = kinematics_after(state, 0.0);
    const double speed = state.velocity.head(robot.space_dimension()).norm();
    const double expected = energy_with({}, k) + 0.5 * payload * speed * speed;
    residual.add(energy_with({.payload = payload}, k) / expected - 1.0);
  }
}

TEST_P(DeviationLaws, InertiaOfLegsAndPlatformAddsUp) {
  Residual residual("kinetic energy without legs and without platform, relative", 1e-12);
  for (const MotionState& state : states) {
    const Kinematics k = kinematics_after(state, 0.0);
    const double whole = energy_with({}, k);
    // What neither scales is left in each: rotors, screws and what is fixed to the platform.
    const double heavier_legs = energy_with({.leg_inertia_scale = of_each_leg(1.5)}, k) - whole;
    const double heavier_platform = energy_with({.platform_inertia_scale = 1.5}, k) - whole;
    const double heavier =
        energy_with({.leg_inertia_scale = of_each_leg(1.5), .platform_inertia_scale = 1.5}, k) - whole;
    EXPECT_GT(heavier_legs, 0.0);
    EXPECT_GT(heavier_platform, 0.0);
    residual.add((heavier_legs + heavier_platform - heavier) / whole);
  }
}

TEST_P(DeviationLaws, WithoutFrictionNothingRubs) {
  const RobotDeviation smooth{.drive_friction_scale = JointVector::Zero(robot.drives()),
                              .passive_friction_scale = of_each_leg(0.0)};
  for (const MotionState& state : states) {
    EXPECT_EQ(dynamics_with(smooth, kinematics_after(state, 0.0)).F_fr_x.norm(), 0.0);
  }
}

MechanismDescription unalterable() {
  return {.name = "unalterable",
          .space = ConfigurationSpace::Kind::plane,
          .drives = {},
          .bodies = {},
          .self_collision_pairs = {},
          .home_pose = {}};
}

/// A mechanism that knows no other parameters.
class Unalterable final : public Mechanism {
 public:
  Unalterable() : Mechanism(unalterable()) {}
  void kinematics(const Configuration&, const PlatformVector&, Kinematics&) const noexcept override {}
  void dynamics(const Kinematics&, Dynamics&) const noexcept override {}
  CartesianVector point_on_body(const Kinematics&, BodyId, const CartesianVector&) const noexcept override {
    return {};
  }
  ContactJacobian contact_jacobian(const Kinematics&, BodyId,
                                   const CartesianVector&) const noexcept override {
    return {};
  }
};

TEST(RobotDeviation, IsRefusedWhereTheMechanismKnowsNoOtherParameters) {
  const auto robot = std::make_shared<const Unalterable>();
  EXPECT_EQ(true_robot(robot, {}), robot);
  EXPECT_THROW(true_robot(robot, {.payload = 1.0}), SetupError);
}

}  // namespace
}  // namespace flinch::test
