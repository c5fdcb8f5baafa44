#include <cmath>
#include <cstddef>

#include "systems/robot/decompositions.h"
#include "systems/robot/planar_leg_dynamics.h"
#include "systems/robot/planar_rrr.h"

namespace flinch {
namespace {

// Accelerations of both links' angles (qa, theta2) while the platform does not accelerate: the second
// derivative of the loop closure, projected on the links.
Eigen::Vector2d joint_acceleration_bias(const PlanarRrrLeg& geometry, const PlanarLegMotion& now,
                                        double phi_rate_squared) {
  const PlanarLeg& leg = now.leg;
  const double along1 = geometry.link1_length * now.qa_rate * now.qa_rate;
  const double along2 = geometry.link2_length * now.theta2_rate * now.theta2_rate;
  const Eigen::Vector2d coupling = phi_rate_squared * leg.arm;
  const double per_lengths = 1.0 / (geometry.link1_length * geometry.link2_length * leg.sin_qp);
  return {(along1 * leg.cos_qp + along2 - coupling.dot(leg.u2)) * (geometry.link2_length * per_lengths),
          (coupling.dot(leg.u1) - along1 - along2 * leg.cos_qp) * (geometry.link1_length * per_lengths)};
}

// M x = b of a mass matrix M, of which the upper half is kept, by its cofactors.
struct MassEquation {
  double m00, m01, m02, m11, m12, m22;
  Eigen::Vector3d b;

  Eigen::Vector3d solve() const {
    const double c00 = m11 * m22 - m12 * m12;
    const double c01 = m02 * m12 - m01 * m22;
    const double c02 = m01 * m12 - m02 * m11;
    const double c11 = m00 * m22 - m02 * m02;
    const double c12 = m01 * m02 - m00 * m12;
    const double c22 = m00 * m11 - m01 * m01;
    const double of_determinant = 1.0 / (m00 * c00 + m01 * c01 + m02 * c02);
    return {(c00 * b[0] + c01 * b[1] + c02 * b[2]) * of_determinant,
            (c01 * b[0] + c11 * b[1] + c12 * b[2]) * of_determinant,
            (c02 * b[0] + c12 * b[1] + c22 * b[2]) * of_determinant};
  }
};

}  // namespace

void PlanarRrr::dynamics(const Kinematics& kinematics, Dynamics& out) const noexcept {
  if (!kinematics.reachable || kinematics.pose.size() != 3) return set_invalid(3, out);
  PlanarDynamics<3> sum;
  sum.M.diagonal() << parameters_.platform_mass, parameters_.platform_mass, parameters_.platform_inertia;
  for (int i = 0; i < 3; ++i) {
    sum.add_leg(parameters_.legs[static_cast<std::size_t>(i)], parameters_.friction_velocity, kinematics, i);
  }
  sum.write(out);
}

// ---------------------------------------------------------------- forward dynamics, fixed size

// In the legs' coordinates (qa, theta2) the kinetic energy is
// (p1 - p2) qa'^2 / 2 + p3 cos(qp) qa' theta2' + p2 theta2'^2 / 2, and the centrifugal torques have one term
// each.
Eigen::Vector3d PlanarRrr::acceleration(const PlanarMotion& motion, const Eigen::Vector3d& drive_torques,
                                        const Eigen::Vector3d& external_wrench) const noexcept {
  const double mass = parameters_.platform_mass;
  MassEquation sum{mass, 0.0, 0.0, mass, 0.0, parameters_.platform_inertia, external_wrench};
  const double phi_rate_squared = motion.velocity.z() * motion.velocity.z();

  for (std::size_t i = 0; i < 3; ++i) {
    const PlanarRrrLeg& parameters = parameters_.legs[i];
    const PlanarLegMotion& now = motion.legs[i];
    const PlanarLeg& leg = now.leg;
    const double first = parameters.inertia.p1 - parameters.inertia.p2 + parameters.rotor_inertia;
    const double second = parameters.inertia.p2;
    const double mixed = parameters.inertia.p3 * leg.cos_qp;
    const double centrifugal = parameters.inertia.p3 * leg.sin_qp;

    const Eigen::Vector2d bias = joint_acceleration_bias(parameters, now, phi_rate_squared);
    const double qa_rate_squared = now.qa_rate * now.qa_rate;
    const double theta2_rate_squared = now.theta2_rate * now.theta2_rate;
    const double smoothing = parameters_.friction_velocity;
    const double passive_friction =
        friction_effort(parameters.passive_friction, now.theta2_rate - now.qa_rate, smoothing);
    const double active_friction = friction_effort(parameters.active_friction, now.qa_rate, smoothing);
    const double torque1 = drive_torques[static_cast<int>(i)] - active_friction + passive_friction -
                           first * bias[0] - mixed * bias[1] + centrifugal * theta2_rate_squared;
    const double torque2 =
        -passive_friction - mixed * bias[0] - second * bias[1] - centrifugal * qa_rate_squared;

    const Eigen::RowVector3d &a = now.J_qa, &b = now.J_theta2;
    const Eigen::RowVector3d momentum1 = first * a + mixed * b;
    const Eigen::RowVector3d momentum2 = mixed * a + second * b;
    sum.m00 += a[0] * momentum1[0] + b[0] * momentum2[0];
    sum.m01 += a[0] * momentum1[1] + b[0] * momentum2[1];
    sum.m02 += a[0] * momentum1[2] + b[0] * momentum2[2];
    sum.m11 += a[1] * momentum1[1] + b[1] * momentum2[1];
    sum.m12 += a[1] * momentum1[2] + b[1] * momentum2[2];
    sum.m22 += a[2] * momentum1[2] + b[2] * momentum2[2];
    sum.b += torque1 * a.transpose() + torque2 * b.transpose();
  }
  return sum.solve();
}

std::optional<Eigen::Vector3d> PlanarRrr::acceleration(
    const Eigen::Vector3d& pose, const Eigen::Vector3d& velocity, const Eigen::Vector3d& drive_torques,
    const Eigen::Vector3d& external_wrench) const noexcept {
  const PlanarMotion now = motion(pose, velocity);
  if (!now.reachable) return std::nullopt;
  const Eigen::Vector3d result = acceleration(now, drive_torques, external_wrench);
  if (!result.allFinite()) return std::nullopt;
  return result;
}

std::optional<JointVector> PlanarRrr::drive_acceleration(const Configuration& pose,
                                                         const PlatformVector& velocity,
                                                         const JointVector& drive_torques) const noexcept {
  if (!usable(pose, 3) || !usable(velocity, 3) || !usable(drive_torques, 3)) return std::nullopt;
  PlanarMotion now;
  motion(pose.head<3>(), velocity.head<3>(), now);
  if (!now.reachable) return std::nullopt;
  const Eigen::Vector3d result =
      drive_accelerations(now, acceleration(now, drive_torques.head<3>(), Eigen::Vector3d::Zero()));
  if (!result.allFinite()) return std::nullopt;
  return JointVector(result);
}

Eigen::Vector3d PlanarRrr::drive_accelerations(const PlanarMotion& motion,
                                               const Eigen::Vector3d& acceleration) const noexcept {
  Eigen::Vector3d result;
  for (int i = 0; i < 3; ++i) {
    const auto leg = static_cast<std::size_t>(i);
    const PlanarLegJacobianRate rate =
        leg_jacobian_rate(geometry_[leg], motion.legs[leg], motion.velocity.z());
    result[i] = motion.legs[leg].J_qa.dot(acceleration) + rate.dJ_qa.dot(motion.velocity);
  }
  return result;
}

double PlanarRrr::kinetic_energy(const PlanarMotion& motion) const noexcept {
  const Eigen::Vector3d squares = motion.velocity.array().square();
  double twice =
      parameters_.platform_mass * (squares.x() + squares.y()) + parameters_.platform_inertia * squares.z();
  for (std::size_t i = 0; i < 3; ++i) {
    const PlanarRrrLeg& leg = parameters_.legs[i];
    const double qa_rate = motion.legs[i].qa_rate;
    const double theta2_rate = motion.legs[i].theta2_rate;
    twice += (leg.inertia.p1 - leg.inertia.p2 + leg.rotor_inertia) * qa_rate * qa_rate +
             2.0 * leg.inertia.p3 * motion.legs[i].leg.cos_qp * qa_rate * theta2_rate +
             leg.inertia.p2 * theta2_rate * theta2_rate;
  }
  return 0.5 * twice;
}

double PlanarRrr::friction_power(const PlanarMotion& motion) const noexcept {
  double power = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const PlanarRrrLeg& leg = parameters_.legs[i];
    const double active = motion.legs[i].qa_rate;
    const double passive = motion.legs[i].theta2_rate - active;
    power += active * friction_effort(leg.active_friction, active, parameters_.friction_velocity) +
             passive * friction_effort(leg.passive_friction, passive, parameters_.friction_velocity);
  }
  return power;
}

}  // namespace flinch
