#pragma once

#include <Eigen/Dense>
#include <array>

#include "systems/robot/planar_rrr_parameters.h"
#include "tests/systems/robot/reference_3rrr.h"

namespace flinch::testing {

/// A planar 3-RRR as rigid bodies; of `parameters`, inertia of the legs is not used.
struct RobotOfBodies {
  PlanarRrrParameters parameters;
  std::array<LinkBody, 3> link1;
  std::array<LinkBody, 3> link2;
};

/// Forward dynamics by Newton and Euler: seven free bodies (x, y, angle each) and 18 joint constraints,
/// solved for accelerations and constraint forces at once. Shares nothing with the robot under test but its
/// parameters.
class ConstrainedBodies {
 public:
  ConstrainedBodies(const RobotOfBodies& robot, const Eigen::Vector3d& pose, const Eigen::Vector3d& velocity)
      : robot_(robot), pose_(pose), velocity_(velocity) {
    masses_.segment<3>(18) << robot.parameters.platform_mass, robot.parameters.platform_mass,
        robot.parameters.platform_inertia;
    rates_[6] = velocity.z();
    for (int leg = 0; leg < 3; ++leg) add_leg(leg);
  }

  Eigen::Vector3d solve(const Eigen::Vector3d& torque, const Eigen::Vector3d& wrench) const {
    Eigen::Matrix<double, 21, 1> forces = Eigen::Matrix<double, 21, 1>::Zero();
    forces.segment<3>(18) = wrench;
    for (int leg = 0; leg < 3; ++leg) {
      const PlanarRrrLeg& parameters = robot_.parameters.legs[static_cast<std::size_t>(leg)];
      const double active_rate = rates_[2 * leg];
      const double passive_rate = rates_[2 * leg + 1] - active_rate;
      const double passive = friction(parameters.passive_friction, passive_rate);
      forces[6 * leg + 2] = torque[leg] - friction(parameters.active_friction, active_rate) + passive;
      forces[6 * leg + 5] = -passive;
    }
    Eigen::Matrix<double, 39, 39> system = Eigen::Matrix<double, 39, 39>::Zero();
    system.topLeftCorner<21, 21>() = masses_.asDiagonal();
    system.topRightCorner<21, 18>() = -constraints_.transpose();
    system.bottomLeftCorner<18, 21>() = constraints_;
    Eigen::Matrix<double, 39, 1> right;
    right << forces, drift_;
    const Eigen::Matrix<double, 39, 1> solution = system.fullPivLu().solve(right);
    return solution.segment<3>(18);
  }

 private:
  double friction(const JointFriction& joint, double rate) const {
    return joint.viscous * rate + joint.coulomb * std::tanh(rate / robot_.parameters.friction_velocity);
  }

  void add_leg(int leg) {
    const auto index = static_cast<std::size_t>(leg);
    const PlanarRrrLeg& p = robot_.parameters.legs[index];
    const LinkBody& first = robot_.link1[index];
    const LinkBody& second = robot_.link2[index];
    const ReferenceLeg geometry{p.base_angle,     p.base_radius,
                                p.coupling_angle, robot_.parameters.coupling_radius,
                                p.link1_length,   p.link2_length};
    const Eigen::Vector3d q = geometry.joints(pose_);
    const double theta1 = p.base_angle + q[0];
    const double theta2 = theta1 + q[1];
    const Eigen::Vector2d u1(std::cos(theta1), std::sin(theta1));
    const Eigen::Vector2d u2(std::cos(theta2), std::sin(theta2));
    const Eigen::Vector2d arm = geometry.coupling(pose_) - pose_.head<2>();

    // Rates of the links from the velocity of the coupling joint.
    const Eigen::Vector2d tip = velocity_.head<2>() + velocity_.z() * turned(arm);
    Eigen::Matrix2d map;
    map << p.link1_length * turned(u1), p.link2_length * turned(u2);
    rates_.segment<2>(2 * leg) = map.inverse() * tip;

    const int link1 = 2 * leg;
    const int link2 = 2 * leg + 1;
    masses_.segment<6>(6 * leg) << first.mass, first.mass, first.inertia + p.rotor_inertia, second.mass,
        second.mass, second.inertia;
    attach(6 * leg, link1, -first.centre_of_mass * u1, 1.0);  // to the base, which does not move
    attach(6 * leg + 2, link1, (p.link1_length - first.centre_of_mass) * u1, 1.0);
    attach(6 * leg + 2, link2, -second.centre_of_mass * u2, -1.0);
    attach(6 * leg + 4, link2, (p.link2_length - second.centre_of_mass) * u2, 1.0);
    attach(6 * leg + 4, 6, arm, -1.0);
  }

  // Adds sign * (centre + r) of a body to two constraint rows: columns, and what its rotation leaves on the
  // right.
  void attach(int row, int body, const Eigen::Vector2d& r, double sign) {
    constraints_.block<2, 2>(row, 3 * body) = sign * Eigen::Matrix2d::Identity();
    constraints_.block<2, 1>(row, 3 * body + 2) = sign * turned(r);
    drift_.segment<2>(row) += sign * rates_[body] * rates_[body] * r;
  }

  static Eigen::Vector2d turned(const Eigen::Vector2d& v) { return {-v.y(), v.x()}; }

  const RobotOfBodies& robot_;
  Eigen::Vector3d pose_;
  Eigen::Vector3d velocity_;
  Eigen::Matrix<double, 7, 1> rates_ = Eigen::Matrix<double, 7, 1>::Zero();
  Eigen::Matrix<double, 21, 1> masses_ = Eigen::Matrix<double, 21, 1>::Zero();
  Eigen::Matrix<double, 18, 21> constraints_ = Eigen::Matrix<double, 18, 21>::Zero();
  Eigen::Matrix<double, 18, 1> drift_ = Eigen::Matrix<double, 18, 1>::Zero();
};

inline Eigen::Vector3d constrained_acceleration(const RobotOfBodies& robot, const Eigen::Vector3d& pose,
                                                const Eigen::Vector3d& velocity,
                                                const Eigen::Vector3d& torque,
                                                const Eigen::Vector3d& wrench) {
  return ConstrainedBodies(robot, pose, velocity).solve(torque, wrench);
}

}  // namespace flinch::testing
