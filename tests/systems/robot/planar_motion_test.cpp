#include <limits>

#include "systems/robot/forward_dynamics.h"
#include "tests/support/allocations.h"
#include "tests/systems/robot/random_motion.h"
#include "tests/systems/robot/residual.h"

namespace flinch::test {
namespace {

// What simulations of the planar 3-RRR call in their inner loop says the same as the general path.
class PlanarMotionPath : public BothGeometries {
 protected:
  Eigen::Vector3d torque{4.0, -7.0, 2.5};
  Eigen::Vector3d wrench{12.0, -5.0, 0.8};
};
FLINCH_FOR_BOTH_GEOMETRIES(PlanarMotionPath);

TEST_P(PlanarMotionPath, AgreesWithTheGeneralOne) {
  Residual acceleration("acceleration, relative", 1e-12);
  Residual energy("kinetic energy [J]", 1e-14);
  Residual friction("power of friction [W]", 1e-13);
  for (const auto& [pose, velocity] : motions) {
    const Kinematics k = kinematics_at(pose, velocity);
    const Dynamics dynamics = dynamics_at(pose, velocity);
    const PlanarMotion motion = robot.motion(pose, velocity);
    const PlatformVector general = *forward_dynamics(k, dynamics, torque, wrench);
    acceleration.add((*robot.acceleration(pose, velocity, torque, wrench) - general).norm() / general.norm());
    energy.add(robot.kinetic_energy(motion) - kinetic_energy(k, dynamics));
    friction.add(robot.friction_power(motion) - friction_power(k, dynamics));
  }
}

TEST_P(PlanarMotionPath, MovesPointsAndTakesForcesAsTheGeneralOne) {
  Residual velocities("velocity of a point [m/s]", 1e-14);
  Residual wrenches("wrench of a force [N, Nm per 50 N]", 1e-12);
  const Eigen::Vector2d force(-40.0, 30.0);
  const Eigen::Vector2d point(0.31, 0.04);
  for (const auto& [pose, velocity] : motions) {
    const Kinematics k = kinematics_at(pose, velocity);
    const PlanarMotion motion = robot.motion(pose, velocity);
    for (int i = 0; i < robot.body_count(); ++i) {
      const BodyId body = BodyId::from_index(i);
      const ContactJacobian contact = robot.contact_jacobian(k, body, point);
      const Eigen::Vector2d in_base = robot.point_on_body(k, body, point);
      velocities.add(point_velocity(motion, body, in_base), contact.translation * velocity);
      wrenches.add(contact_wrench(motion, body, in_base, force), platform_wrench(contact, force));
    }
  }
}

// Half a second of free motion without friction, by the classical Runge-Kutta method.
TEST_P(PlanarMotionPath, FreeMotionKeepsItsEnergy) {
  const PlanarRrr free(rig_robot(GetParam(), RigFriction::none));
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  Eigen::Vector3d x(0.02, -0.05, -0.1);
  Eigen::Vector3d v(0.2, 0.1, -0.5);
  const double energy = free.kinetic_energy(free.motion(x, v));
  const double h = 1e-4;
  for (int step = 0; step < 5000; ++step) {
    const Eigen::Vector3d a1 = *free.acceleration(x, v, zero, zero);
    const Eigen::Vector3d v2 = v + 0.5 * h * a1;
    const Eigen::Vector3d a2 = *free.acceleration(x + 0.5 * h * v, v2, zero, zero);
    const Eigen::Vector3d v3 = v + 0.5 * h * a2;
    const Eigen::Vector3d a3 = *free.acceleration(x + 0.5 * h * v2, v3, zero, zero);
    const Eigen::Vector3d v4 = v + h * a3;
    const Eigen::Vector3d a4 = *free.acceleration(x + h * v3, v4, zero, zero);
    x += h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4);
    v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
  }
  Residual residual("energy drift in 0.5 s, relative", 1e-11);
  residual.add(free.kinetic_energy(free.motion(x, v)) / energy - 1.0);
  EXPECT_GT((x - Eigen::Vector3d(0.02, -0.05, -0.1)).norm(), 0.05);
}

TEST_P(PlanarMotionPath, NeverAllocates) {
  const test::AllocationCounter counter;
  double sum = 0.0;
  for (const auto& [pose, velocity] : motions) {
    const PlanarMotion motion = robot.motion(pose, velocity);
    const Eigen::Vector2d force = point_velocity(motion, BodyId::link2(1), Eigen::Vector2d(0.1, 0.2));
    const Eigen::Vector3d F = contact_wrench(motion, BodyId::link2(1), Eigen::Vector2d(0.1, 0.2), force);
    sum += robot.acceleration(pose, velocity, torque, F)->norm();
    sum += robot.kinetic_energy(motion) + robot.friction_power(motion);
  }
  EXPECT_EQ(counter.count(), 0);
  EXPECT_GT(sum, 0.0);
}

TEST_P(PlanarMotionPath, HasNoResultOutOfReachOrForNumbersThatAreNone) {
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  const Eigen::Vector3d bad(0.0, std::numeric_limits<double>::quiet_NaN(), 0.0);
  EXPECT_FALSE(robot.acceleration(Eigen::Vector3d(3.0, 0.0, 0.0), zero, zero, zero).has_value());
  EXPECT_FALSE(robot.acceleration(bad, zero, zero, zero).has_value());
  EXPECT_FALSE(robot.acceleration(zero, bad, zero, zero).has_value());
  EXPECT_FALSE(robot.acceleration(zero, zero, bad, zero).has_value());
  EXPECT_TRUE(robot.acceleration(zero, zero, zero, zero).has_value());
}

}  // namespace
}  // namespace flinch::test
