#include <limits>

#include "tests/systems/robot/constrained_bodies.h"
#include "tests/systems/robot/random_motion.h"
#include "tests/systems/robot/residual.h"

namespace flinch::testing {
namespace {

// Different inertia, rotor and friction in every leg, so that no symmetry hides a mistake.
RobotOfBodies uneven_robot(BenchGeometry geometry) {
  RobotOfBodies robot{bench_robot(geometry, BenchFriction::test_bench), {}, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    const double factor = 1.0 + 0.15 * static_cast<double>(i);
    robot.link1[i] = {2.272 * factor, 0.29 + 0.01 * static_cast<double>(i), 0.064 * factor};
    robot.link2[i] = {0.75 / factor, 0.311 - 0.02 * static_cast<double>(i), 0.024 * factor};
    PlanarRrrLeg& leg = robot.parameters.legs[i];
    leg.inertia = base_parameters(robot.link1[i], robot.link2[i], leg.link1_length);
    leg.rotor_inertia = 0.01 * factor;
    leg.passive_friction.coulomb = 0.02 * factor;
  }
  return robot;
}

class ForwardDynamics : public BothGeometries {
 protected:
  RobotOfBodies bodies = uneven_robot(GetParam());
  PlanarRrr uneven{bodies.parameters};
  Eigen::Vector3d torque{4.0, -7.0, 2.5};
  Eigen::Vector3d wrench{12.0, -5.0, 0.8};
};
FLINCH_FOR_BOTH_GEOMETRIES(ForwardDynamics);

TEST_P(ForwardDynamics, AgreesWithSevenBodiesHeldTogetherByConstraintForces) {
  Residual residual("acceleration against 21 constrained coordinates, relative", 1e-12);
  for (const auto& [pose, velocity] : motions) {
    const auto acceleration = uneven.acceleration(pose, velocity, torque, wrench);
    ASSERT_TRUE(acceleration.has_value());
    const Eigen::Vector3d reference = constrained_acceleration(bodies, pose, velocity, torque, wrench);
    residual.add((*acceleration - reference).norm() / reference.norm());
  }
}

TEST_P(ForwardDynamics, AgreesWithTheMatricesOfTheGeneralPath) {
  Residual residual("acceleration against M_x, C_x, F_fr, relative", 1e-12);
  for (const auto& [pose, velocity] : motions) {
    Kinematics k;
    Dynamics dynamics;
    uneven.kinematics(pose, velocity, k);
    uneven.dynamics(k, dynamics);
    const Eigen::Vector3d general = Eigen::Matrix3d(dynamics.M_x)
                                        .ldlt()
                                        .solve(platform_wrench(k, torque) + wrench - dynamics.C_x * velocity -
                                               dynamics.g_x - dynamics.F_fr_x);
    residual.add((*uneven.acceleration(pose, velocity, torque, wrench) - general).norm() / general.norm());
  }
}

TEST_P(ForwardDynamics, KineticEnergyIsThatOfTheMassMatrix) {
  Residual residual("kinetic energy [J]", 1e-14);
  for (const auto& [pose, velocity] : motions) {
    Kinematics k;
    Dynamics dynamics;
    uneven.kinematics(pose, velocity, k);
    uneven.dynamics(k, dynamics);
    residual.add(uneven.kinetic_energy(uneven.motion(pose, velocity)) -
                 0.5 * velocity.dot(dynamics.M_x * velocity));
  }
}

TEST_P(ForwardDynamics, EnergyChangesByThePowerOfDrivesForcesAndFriction) {
  Residual residual("power balance [W]", 1e-8);
  for (const PoseAndVelocity& motion : motions) {
    const auto& pose = motion.pose;
    const auto& velocity = motion.velocity;
    const Eigen::Vector3d a = *uneven.acceleration(pose, velocity, torque, wrench);
    const double energy_rate = derivative(
        [&](double h) {
          const Eigen::Vector3d moved = pose + h * velocity + 0.5 * h * h * a;
          return uneven.kinetic_energy(uneven.motion(moved, velocity + h * a));
        },
        1e-5);
    const PlanarMotion now = uneven.motion(pose, velocity);
    const Eigen::Vector3d drive_rates(now.legs[0].qa_rate, now.legs[1].qa_rate, now.legs[2].qa_rate);
    const double friction = uneven.friction_power(now);
    EXPECT_GE(friction, 0.0);
    residual.add(energy_rate - (torque.dot(drive_rates) + wrench.dot(velocity) - friction));
  }
}

// Half a second of free motion without friction, by the classical Runge-Kutta method.
TEST_P(ForwardDynamics, FreeMotionKeepsItsEnergy) {
  const PlanarRrr free(bench_robot(GetParam(), BenchFriction::none));
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

TEST_P(ForwardDynamics, HasNoResultOutOfReachOrForNumbersThatAreNone) {
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  const Eigen::Vector3d bad(0.0, std::numeric_limits<double>::quiet_NaN(), 0.0);
  EXPECT_FALSE(robot.acceleration(Eigen::Vector3d(3.0, 0.0, 0.0), zero, zero, zero).has_value());
  EXPECT_FALSE(robot.acceleration(bad, zero, zero, zero).has_value());
  EXPECT_FALSE(robot.acceleration(zero, bad, zero, zero).has_value());
  EXPECT_FALSE(robot.acceleration(zero, zero, bad, zero).has_value());
  EXPECT_TRUE(robot.acceleration(zero, zero, zero, zero).has_value());
}

}  // namespace
}  // namespace flinch::testing
