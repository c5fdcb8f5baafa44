#include <gtest/gtest.h>

#include "systems/robot/forward_dynamics.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "systems/robot/rotation.h"
#include "tests/systems/robot/residual.h"

namespace flinch::test {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

/// A hexapod without friction whose drives are springs, so that its energy stays what it is. Its motion is
/// integrated by the classical Runge-Kutta method in increments xi from the pose at a step's beginning:
/// dxi/dt = (dp, J_l(xi)^-1 omega).
class SpringHexapod {
 public:
  explicit SpringHexapod(HexapodPayload payload) : robot_(hexapod_robot(payload)) {
    Kinematics home;
    Dynamics dynamics;
    robot_.kinematics(robot_.home_pose(), Vector6(Vector6::Zero()), home);
    robot_.dynamics(home, dynamics);
    rest_ = home.joints.active;
    holding_ = drive_torques(home, dynamics.g_x);
    pose_ = robot_.home_pose();
    velocity_ << 0.25, -0.2, 0.15, 0.8, -0.6, 0.9;
  }

  void step(double h) {
    const Vector6 none = Vector6::Zero();
    const Rates a = rates(none, velocity_);
    const Rates b = rates(0.5 * h * a.xi, velocity_ + 0.5 * h * a.velocity);
    const Rates c = rates(0.5 * h * b.xi, velocity_ + 0.5 * h * b.velocity);
    const Rates d = rates(h * c.xi, velocity_ + h * c.velocity);
    const Vector6 xi = h / 6.0 * (a.xi + 2.0 * b.xi + 2.0 * c.xi + d.xi);
    pose_ = robot_.space().plus(pose_, xi);
    velocity_ += h / 6.0 * (a.velocity + 2.0 * b.velocity + 2.0 * c.velocity + d.velocity);
  }

  double kinetic() const {
    const auto [k, dynamics] = at(pose_, velocity_);
    return kinetic_energy(k, dynamics);
  }
  double energy() const {
    const auto [k, dynamics] = at(pose_, velocity_);
    const HexapodParameters& p = robot_.parameters();
    const auto height = [&, &k = k](BodyId body, const RigidBodyInertia& inertia) {
      return inertia.mass * 9.81 * robot_.point_on_body(k, body, inertia.centre_of_mass)[2];
    };
    double potential = height(BodyId::platform(), p.payload ? together(p.platform, *p.payload) : p.platform);
    for (int i = 0; i < 6; ++i) {
      potential += height(BodyId::link1(i), p.cylinder) + height(BodyId::link2(i), p.rod);
    }
    const Vector6 stretch = k.joints.active - rest_;
    return kinetic_energy(k, dynamics) + potential + 0.5 * stiffness * stretch.squaredNorm() -
           holding_.dot(stretch);
  }

 private:
  static constexpr double stiffness = 2000.0;  // [N/m]

  struct Rates {
    Vector6 xi, velocity;
  };

  std::pair<Kinematics, Dynamics> at(const Configuration& pose, const Vector6& velocity) const {
    std::pair<Kinematics, Dynamics> both;
    robot_.kinematics(pose, velocity, both.first);
    robot_.dynamics(both.first, both.second);
    return both;
  }
  Rates rates(const Vector6& xi, const Vector6& velocity) const {
    const auto [k, dynamics] = at(robot_.space().plus(pose_, xi), velocity);
    const Vector6 forces = holding_ - stiffness * (k.joints.active - rest_);
    Rates rates;
    rates.xi << velocity.head<3>(), inverse_left_jacobian(xi.tail<3>()) * velocity.tail<3>();
    rates.velocity = forward_dynamics(k, dynamics, forces, Vector6(Vector6::Zero())).value();
    return rates;
  }

  Hexapod robot_;
  Vector6 rest_, holding_;
  Configuration pose_;
  Vector6 velocity_;
};

TEST(HexapodOnSprings, KeepsItsEnergyForFiveSeconds) {
  Residual residual("drift of the energy in 5 s, of its kinetic part", 1e-8);
  for (const HexapodPayload payload : {HexapodPayload::none, HexapodPayload::eccentric}) {
    SpringHexapod hexapod(payload);
    const double kinetic = hexapod.kinetic();
    const double energy = hexapod.energy();
    for (int step = 0; step < 10000; ++step) {
      hexapod.step(5e-4);
      if (step % 100 == 99) residual.add((hexapod.energy() - energy) / kinetic);
    }
  }
}

}  // namespace
}  // namespace flinch::test
