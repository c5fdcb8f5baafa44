#include "systems/robot/robot_deviation.h"

#include <algorithm>

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

TEST_P(DeviationLaws, InertiaOfEachLegAndOfThePlatformGrowsByItsScale) {
  Residual residual("kinetic energy of legs and platform by themselves, relative", 1e-12);
  for (const MotionState& state : states) {
    const Kinematics k = kinematics_after(state, 0.0);
    const double whole = energy_with({}, k);
    const auto gain = [&](const RobotDeviation& deviation) { return energy_with(deviation, k) - whole; };
    const auto legs = [&](double scale) { return RobotDeviation{.leg_inertia_scale = of_each_leg(scale)}; };
    EXPECT_GT(gain(legs(1.5)), 0.0);
    residual.add((gain(legs(2.0)) - 2.0 * gain(legs(1.5))) / whole);
    const double platform = gain({.platform_inertia_scale = 1.5});
    EXPECT_GT(platform, 0.0);
    residual.add((gain({.platform_inertia_scale = 2.0}) - 2.0 * platform) / whole);
    double one_by_one = 0.0;
    for (int leg = 0; leg < robot.legs(); ++leg) {
      RobotDeviation deviation = legs(1.0);
      deviation.leg_inertia_scale[leg] = 1.5;
      one_by_one += gain(deviation);
    }
    residual.add((one_by_one - gain(legs(1.5))) / whole);
  }
}

TEST_P(DeviationLaws, DrivesAndPassiveJointsRubByTheirOwnScales) {
  Residual residual("friction of drives, of passive joints and of all, relative", 1e-12);
  Residual crossed("friction of one drive felt at the others, relative", 1e-12);
  const auto friction = [&](double drives, double passive, const Kinematics& k) {
    return dynamics_with({.drive_friction_scale = JointVector::Constant(robot.drives(), drives),
                          .passive_friction_scale = of_each_leg(passive)},
                         k)
        .F_fr_x;
  };
  for (const MotionState& state : states) {
    const Kinematics k = kinematics_after(state, 0.0);
    EXPECT_EQ(friction(0.0, 0.0, k).norm(), 0.0);
    const PlatformVector of_drives = friction(1.0, 0.0, k), of_passive = friction(0.0, 1.0, k);
    const PlatformVector sum = 2.0 * of_drives + 3.0 * of_passive;
    residual.add((friction(2.0, 3.0, k) - sum).norm() / std::max(1.0, sum.norm()));
    if (robot.drives() != n) crossed.add(0.0);  // whose efforts do not follow from the wrench
    for (int drive = 0; robot.drives() == n && drive < n; ++drive) {
      const JointVector alone = JointVector::Unit(n, drive);
      const JointVector efforts = drive_torques(
          k, dynamics_with({.drive_friction_scale = alone, .passive_friction_scale = of_each_leg(0.0)}, k)
                 .F_fr_x);
      EXPECT_GE(efforts[drive] * k.rates.active[drive], 0.0);
      crossed.add((efforts - efforts[drive] * alone).norm() / std::max(1.0, efforts.norm()));
    }
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
