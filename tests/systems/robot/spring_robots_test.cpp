#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "systems/robot/forward_dynamics.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "systems/robot/joint_friction.h"
#include "systems/robot/legs/legs_robot.h"
#include "systems/robot/rotation.h"
#include "tests/systems/robot/legs_cases.h"
#include "tests/systems/robot/residual.h"

namespace flinch::test {
namespace {

LegsParameters without_friction(LegsParameters parameters) {
  for (RobotLeg& leg : parameters.legs)
    for (LegJoint& joint : leg.joints) joint.friction = {};
  return parameters;
}

/// A robot without friction whose drives are springs, so that its energy stays what it is. Its motion is
/// integrated by the classical Runge-Kutta method in increments xi from the pose at a step's beginning; of
/// three rotations dxi/dt = (dp, J_l(xi)^-1 omega).
class SpringRobot {
 public:
  /// `bodies` by index; `stiffness` of each drive [Nm/rad or N/m].
  SpringRobot(const ParallelRobot& robot, const std::vector<RigidBodyInertia>& bodies,
              const Eigen::Vector3d& gravity, double stiffness, const PlatformVector& velocity)
      : robot_(robot), bodies_(bodies), gravity_(gravity), stiffness_(stiffness), velocity_(velocity) {
    pose_ = robot_.home_pose();
    const auto [home, dynamics] = at(pose_, PlatformVector::Zero(robot_.dof()));
    rest_ = home.joints.active;
    holding_ = drive_torques(home, dynamics.g_x);
  }

  void step(double h) {
    const PlatformVector none = PlatformVector::Zero(robot_.dof());
    const Rates a = rates(none, velocity_);
    const Rates b = rates(0.5 * h * a.xi, velocity_ + 0.5 * h * a.velocity);
    const Rates c = rates(0.5 * h * b.xi, velocity_ + 0.5 * h * b.velocity);
    const Rates d = rates(h * c.xi, velocity_ + h * c.velocity);
    const PlatformVector xi = h / 6.0 * (a.xi + 2.0 * b.xi + 2.0 * c.xi + d.xi);
    pose_ = robot_.space().plus(pose_, xi);
    velocity_ += h / 6.0 * (a.velocity + 2.0 * b.velocity + 2.0 * c.velocity + d.velocity);
  }

  double kinetic() const {
    const auto [k, dynamics] = at(pose_, velocity_);
    return kinetic_energy(k, dynamics);
  }
  double energy() const {
    const auto [k, dynamics] = at(pose_, velocity_);
    double potential = 0.0;
    for (int i = 0; i < robot_.body_count(); ++i) {
      const RigidBodyInertia& body = bodies_[static_cast<std::size_t>(i)];
      const auto dimensions = static_cast<Eigen::Index>(robot_.space_dimension());
      const CartesianVector centre = body.centre_of_mass.head(dimensions);
      potential -=
          body.mass * gravity_.head(dimensions).dot(robot_.point_on_body(k, BodyId::from_index(i), centre));
    }
    const JointVector stretch = k.joints.active - rest_;
    return kinetic_energy(k, dynamics) + potential + 0.5 * stiffness_ * stretch.squaredNorm() -
           holding_.dot(stretch);
  }

 private:
  struct Rates {
    PlatformVector xi, velocity;
  };

  std::pair<Kinematics, Dynamics> at(const Configuration& pose, const PlatformVector& velocity) const {
    std::pair<Kinematics, Dynamics> both;
    robot_.kinematics(pose, velocity, both.first);
    robot_.dynamics(both.first, both.second);
    return both;
  }
  Rates rates(const PlatformVector& xi, const PlatformVector& velocity) const {
    const auto [k, dynamics] = at(robot_.space().plus(pose_, xi), velocity);
    const JointVector efforts = holding_ - stiffness_ * (k.joints.active - rest_);
    Rates rates{velocity, {}};
    if (robot_.space().rotations() == 3)
      rates.xi.tail<3>() = inverse_left_jacobian(xi.tail<3>()) * velocity.tail<3>();
    rates.velocity = forward_dynamics(k, dynamics, efforts, PlatformVector::Zero(robot_.dof())).value();
    return rates;
  }

  const ParallelRobot& robot_;
  const std::vector<RigidBodyInertia>& bodies_;
  Eigen::Vector3d gravity_;
  double stiffness_;
  JointVector rest_, holding_;
  Configuration pose_;
  PlatformVector velocity_;
};

void expect_to_keep_its_energy(const std::string& name, SpringRobot robot) {
  Residual residual(name + ": drift of the energy in 5 s, of its kinetic part", 1e-8);
  const double kinetic = robot.kinetic();
  const double energy = robot.energy();
  for (int step = 0; step < 10000; ++step) {
    robot.step(5e-4);
    if (step % 100 == 99) residual.add((robot.energy() - energy) / kinetic);
  }
}

TEST(LegsOnSprings, KeepTheirEnergyForFiveSeconds) {
  const std::filesystem::path robots = std::filesystem::path(FLINCH_SOURCE_DIR) / "apps/robots";
  const std::vector<std::string> files = {"delta",     "planar_3rpr",  "planar_4rrr",
                                          "hexa_6rus", "linapod_6pus", "tricept"};
  const std::vector<MechanismCase> cases = legs_cases();
  ASSERT_EQ(cases.size(), files.size());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const LegsParameters parameters = without_friction(legs_parameters_of(robots / (files[i] + ".yaml")));
    const LegsRobot robot(parameters);
    const double stiffness = robot.drive_kind(0) == DriveKind::revolute ? 10.0 : 1000.0;
    expect_to_keep_its_energy(
        files[i], {robot, cases[i].bodies, parameters.gravity, stiffness, 0.2 * cases[i].velocity});
  }
}

TEST(HexapodOnSprings, KeepsItsEnergyForFiveSeconds) {
  for (const HexapodPayload payload : {HexapodPayload::none, HexapodPayload::eccentric}) {
    const HexapodParameters p = hexapod_robot(payload);
    const Hexapod robot(p);
    std::vector<RigidBodyInertia> bodies = {p.payload ? together(p.platform, *p.payload) : p.platform};
    for (int i = 0; i < 6; ++i) bodies.insert(bodies.end(), {p.cylinder, p.rod});
    expect_to_keep_its_energy(
        "hexapod", {robot, bodies, p.gravity, 2000.0, PlatformVector{{0.25, -0.2, 0.15, 0.8, -0.6, 0.9}}});
  }
}

}  // namespace
}  // namespace flinch::test
