#include <cstddef>

#include "systems/robot/hexapod.h"
#include "systems/robot/motion_equations.h"
#include "systems/robot/rotation.h"

namespace flinch {

void Hexapod::dynamics(const Kinematics& kinematics, Dynamics& out) const noexcept {
  if (!serves(kinematics, BodyId::platform(), Eigen::Vector3d::Zero())) return set_invalid(6, out);
  const HexapodParameters& p = parameters_;
  const Platform at = platform(kinematics.pose, kinematics.velocity);
  const Twist& v = at.velocity;
  BodyDynamics<6> sum;
  Twist friction = Twist::Zero();
  sum.add_body(loaded_platform_, platform_motion(at), v, p.gravity);
  for (std::size_t i = 0; i < 6; ++i) {
    const Leg closed = leg(i, at);
    const LegRates moving = rates(closed, at);
    const PointMotion<6> joint = joint_motion(closed, at);
    const UniversalLeg<6> turning = universal(i, closed, moving, joint);
    sum.add_body(cylinders_[i], cylinder_motion(i, turning), v, p.gravity);
    sum.add_body(rods_[i], rod_motion(closed, joint, turning, at), v, p.gravity);
    sum.add_armature(p.drive_armature, moving.row, moving.row_rate);
    const auto resist = [&](const JointFriction& of, const Row& row, double friction_velocity) {
      friction += row.transpose() * friction_effort(of, row.dot(v), friction_velocity);
    };
    resist(p.legs[i].drive_friction, moving.row, p.drive_friction_velocity);
    resist(p.legs[i].universal_friction, turning.J_first, p.universal_friction_velocity);
    resist(p.legs[i].universal_friction, turning.J_second, p.universal_friction_velocity);
  }
  if (!sum.M.allFinite() || !sum.C.allFinite() || !friction.allFinite()) return set_invalid(6, out);
  out.M_x = sum.M;
  out.C_x = sum.C;
  out.g_x = sum.g;
  out.F_fr_x = friction;
  out.valid = true;
}

// ---------------------------------------------------------------- for an integration

// A body needs, with a_o and alpha the accelerations of its origin and of itself while dv = 0, c from its
// origin to its centre of mass, and I about its origin,
//   f = m (a_o + alpha x c + omega x (omega x c) - g),  n = I alpha + omega x I omega + m c x (a_o - g),
// and h = J_o^T f + J_w^T n. No time derivative of a Jacobian is formed.

void Hexapod::equations_of_motion(const Configuration& pose, const PlatformVector& velocity,
                                  Kinematics& kinematics, MotionEquations& equations) const noexcept {
  Closed closed;
  equations.valid = close(pose, velocity, home_working_mode(), closed, kinematics);
  if (!equations.valid) return;
  Equations sum = platform_equations(closed.platform);
  for (std::size_t i = 0; i < 6; ++i) add_leg(i, closed.legs[i], closed.platform, sum);
  equations.valid = sum.M.allFinite() && sum.h.allFinite();
  equations.M_x = sum.M;
  equations.h_x = sum.h;
}

// J_o = [1, 0], J_w = [0, 1].
Hexapod::Equations Hexapod::platform_equations(const Platform& at) const noexcept {
  const Eigen::Vector3d& g = parameters_.gravity;
  const Eigen::Vector3d omega = at.velocity.tail<3>();
  const Eigen::Vector3d c = at.axes * loaded_platform_.centre_of_mass;
  const Eigen::Matrix3d I = at.axes * platform_inertia_ * at.axes.transpose();
  const double m = loaded_platform_.mass;
  const Eigen::Matrix3d S = m * cross_matrix(c);
  Equations sum;
  sum.M << m * Eigen::Matrix3d::Identity(), -S, S, I;
  sum.h << m * (omega.cross(omega.cross(c)) - g), omega.cross(I * omega) - m * c.cross(g);
  return sum;
}

// Both links turn alike, so that I is that of both, each about its own joint. The cylinder's joint is fixed;
// the rod's has J_o = [1, -S(r)], a_o = omega x (omega x r).
void Hexapod::add_leg(std::size_t index, const MovingLeg& moving, const Platform& at,
                      Equations& sum) const noexcept {
  const HexapodParameters& p = parameters_;
  const HexapodLeg& of = p.legs[index];
  const Leg& leg = moving.leg;
  const LegRates& rates = moving.rates;
  const Eigen::Vector3d& r = leg.arm;
  const Eigen::Vector3d omega = at.velocity.tail<3>();
  const UniversalTurn turn = universal_turn(of.universal_axis, leg.direction, rates.direction_rate);
  const Map J_joint = joint_motion(leg, at).J;
  const Map J_w = turn.W * ((J_joint - leg.direction * rates.row) / leg.length);

  // While dv = 0, of the rod's joint, of the leg's direction, and of the links.
  const Eigen::Vector3d a_o = omega.cross(omega.cross(r));
  const double row_drift = rates.row_rate.dot(at.velocity);
  const Eigen::Vector3d a_direction =
      (a_o - 2.0 * rates.length_rate * rates.direction_rate - row_drift * leg.direction) / leg.length;
  const Eigen::Vector3d turning = turn.W * rates.direction_rate;
  const Eigen::Vector3d alpha = turn.W_rate * rates.direction_rate + turn.W * a_direction;

  const double m = rods_[index].mass;
  const Eigen::Vector3d c = turn.axes * rods_[index].centre_of_mass;
  const Eigen::Vector3d of_cylinder = cylinders_[index].mass * (turn.axes * cylinders_[index].centre_of_mass);
  const Eigen::Matrix3d I = turn.axes * link_inertia_[index] * turn.axes.transpose();
  const Eigen::Vector3d f = m * (a_o + alpha.cross(c) + turning.cross(turning.cross(c)) - p.gravity);
  const Eigen::Vector3d n =
      I * alpha + turning.cross(I * turning) + m * c.cross(a_o - p.gravity) - of_cylinder.cross(p.gravity);

  // J_o^T X = [X; S(r) X].
  const Eigen::Matrix3d S = cross_matrix(r);
  const Map S_c_J_w = m * cross_matrix(c) * J_w;
  Eigen::Matrix<double, 6, 6> crossed;
  crossed << S_c_J_w, S * S_c_J_w;
  Eigen::Matrix<double, 6, 6>& M = sum.M;
  M.noalias() += J_w.transpose() * (I * J_w) + p.drive_armature * rates.row.transpose() * rates.row;
  M -= crossed + crossed.transpose();
  M.topLeftCorner<3, 3>().diagonal().array() += m;
  M.topRightCorner<3, 3>() -= m * S;
  M.bottomLeftCorner<3, 3>() += m * S;
  M.bottomRightCorner<3, 3>() -= m * S * S;
  sum.h += J_joint.transpose() * f + J_w.transpose() * n;
  sum.h += p.drive_armature * row_drift * rates.row.transpose();

  // The first axis lies across the leg: its row is first . (J_o - s row) / q, and first . s = 0.
  const double first_rate = turn.first.dot(rates.direction_rate);
  const double second_rate = turn.second.dot(turning);
  const auto universal = [&](double rate) {
    return friction_effort(of.universal_friction, rate, p.universal_friction_velocity);
  };
  sum.h += J_joint.transpose() * (universal(first_rate) / leg.length * turn.first) +
           J_w.transpose() * (universal(second_rate) * turn.second) +
           friction_effort(of.drive_friction, rates.length_rate, p.drive_friction_velocity) *
               rates.row.transpose();
}

}  // namespace flinch
