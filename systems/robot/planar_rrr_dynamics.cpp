#include <Eigen/LU>
#include <cmath>
#include <cstddef>

#include "systems/robot/planar_kinematics.h"
#include "systems/robot/planar_rrr.h"

namespace flinch {
namespace {

using LegJacobian = Eigen::Matrix<double, 2, 3>;

double friction_torque(const JointFriction& friction, double rate, double smoothing) {
  const double viscous = friction.viscous * rate;
  return friction.coulomb == 0.0 ? viscous : viscous + friction.coulomb * std::tanh(rate / smoothing);
}

LegJacobian leg_rows(const PlatformMatrix& active, const PlatformMatrix& passive, int leg) {
  LegJacobian rows;
  rows << active(leg, 0), active(leg, 1), active(leg, 2), passive(leg, 0), passive(leg, 1), passive(leg, 2);
  return rows;
}

// cos and sin of the passive angle, from the directions of the links.
Eigen::Vector2d passive_direction(const LegPoints& leg) {
  const Eigen::Vector2d link1 = (leg.passive_joint - leg.base_joint).head<2>();
  const Eigen::Vector2d link2 = (leg.coupling_joint - leg.passive_joint).head<2>();
  return Eigen::Vector2d(link1.dot(link2), cross(link1, link2)) / (link1.norm() * link2.norm());
}

// Accelerations of both links' angles (qa, theta2) while the platform does not accelerate: the second
// derivative of the loop closure, projected on the links.
Eigen::Vector2d joint_acceleration_bias(const PlanarRrrLeg& geometry, const PlanarLegMotion& now,
                                        double phi_rate_squared) {
  const PlanarLeg& leg = now.leg;
  const double along1 = geometry.link1_length * now.qa_rate * now.qa_rate;
  const double along2 = geometry.link2_length * now.theta2_rate * now.theta2_rate;
  const Eigen::Vector2d coupling = phi_rate_squared * leg.arm;
  return {(along1 * leg.cos_qp + along2 - coupling.dot(leg.u2)) / (geometry.link1_length * leg.sin_qp),
          (coupling.dot(leg.u1) - along1 - along2 * leg.cos_qp) / (geometry.link2_length * leg.sin_qp)};
}

void set_zero(Dynamics& out) {
  out = Dynamics();
  out.M_x.setZero(3, 3);
  out.C_x.setZero(3, 3);
  out.g_x.setZero(3);
  out.F_fr_x.setZero(3);
}

}  // namespace

// Subsystem method in the legs' coordinates (qa, qp). [ICRA23] (7), [SafePR] (4)
void PlanarRrr::dynamics(const Kinematics& kinematics, Dynamics& out) const noexcept {
  if (!kinematics.reachable || kinematics.pose.size() != 3) return set_zero(out);
  Eigen::Matrix3d M_x =
      Eigen::Vector3d(parameters_.platform_mass, parameters_.platform_mass, parameters_.platform_inertia)
          .asDiagonal();
  Eigen::Matrix3d C_x = Eigen::Matrix3d::Zero();
  Eigen::Vector3d F_fr_x = Eigen::Vector3d::Zero();

  for (int i = 0; i < 3; ++i) {
    const PlanarRrrLeg& leg = parameters_.legs[static_cast<std::size_t>(i)];
    const LegJacobian J = leg_rows(kinematics.J_qa_x, kinematics.J_qp_x, i);
    const LegJacobian dJ = leg_rows(kinematics.dJ_qa_x, kinematics.dJ_qp_x, i);
    const double qa_rate = kinematics.rates.active[i];
    const double qp_rate = kinematics.rates.passive[i];
    const Eigen::Vector2d qp = passive_direction(kinematics.legs[static_cast<std::size_t>(i)]);
    const double p1 = leg.inertia.p1 + leg.rotor_inertia;
    const double p2 = leg.inertia.p2;
    const double p3_c = leg.inertia.p3 * qp.x();
    const double p3_s = leg.inertia.p3 * qp.y();

    Eigen::Matrix2d M_leg;
    M_leg << p1 + 2.0 * p3_c, p2 + p3_c, p2 + p3_c, p2;
    Eigen::Matrix2d C_leg;
    C_leg << -p3_s * qp_rate, -p3_s * (qa_rate + qp_rate), p3_s * qa_rate, 0.0;
    const Eigen::Vector2d friction(
        friction_torque(leg.active_friction, qa_rate, parameters_.friction_velocity),
        friction_torque(leg.passive_friction, qp_rate, parameters_.friction_velocity));

    M_x += J.transpose() * M_leg * J;
    C_x += J.transpose() * (M_leg * dJ + C_leg * J);
    F_fr_x += J.transpose() * friction;
  }

  if (!M_x.allFinite() || !C_x.allFinite() || !F_fr_x.allFinite()) return set_zero(out);
  out.M_x = M_x;
  out.C_x = C_x;
  out.g_x.setZero(3);  // The plane of motion is horizontal.
  out.F_fr_x = F_fr_x;
  out.valid = true;
}

// ---------------------------------------------------------------- forward dynamics, fixed size

// In the legs' coordinates (qa, theta2) the kinetic energy is
// (p1 - p2) qa'^2 / 2 + p3 cos(qp) qa' theta2' + p2 theta2'^2 / 2, and the centrifugal torques have one term
// each.
Eigen::Vector3d PlanarRrr::acceleration(const PlanarMotion& motion, const Eigen::Vector3d& drive_torques,
                                        const Eigen::Vector3d& external_wrench) const noexcept {
  Eigen::Matrix3d M =
      Eigen::Vector3d(parameters_.platform_mass, parameters_.platform_mass, parameters_.platform_inertia)
          .asDiagonal();
  Eigen::Vector3d wrench = external_wrench;
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
        friction_torque(parameters.passive_friction, now.theta2_rate - now.qa_rate, smoothing);
    const double active_friction = friction_torque(parameters.active_friction, now.qa_rate, smoothing);
    const double torque1 = drive_torques[static_cast<int>(i)] - active_friction + passive_friction -
                           first * bias[0] - mixed * bias[1] + centrifugal * theta2_rate_squared;
    const double torque2 =
        -passive_friction - mixed * bias[0] - second * bias[1] - centrifugal * qa_rate_squared;

    const Eigen::RowVector3d momentum1 = first * now.J_qa + mixed * now.J_theta2;
    const Eigen::RowVector3d momentum2 = mixed * now.J_qa + second * now.J_theta2;
    M.noalias() += now.J_qa.transpose() * momentum1 + now.J_theta2.transpose() * momentum2;
    wrench.noalias() += torque1 * now.J_qa.transpose() + torque2 * now.J_theta2.transpose();
  }
  return M.inverse() * wrench;
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
    power += active * friction_torque(leg.active_friction, active, parameters_.friction_velocity) +
             passive * friction_torque(leg.passive_friction, passive, parameters_.friction_velocity);
  }
  return power;
}

}  // namespace flinch
