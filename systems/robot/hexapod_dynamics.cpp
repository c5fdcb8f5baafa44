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

// Links of a leg turn alike, so that what they sum up to needs their inertia about their own joints alone,
// cylinder's and rod's together. With the accelerations a_o of a body's origin and alpha of the body at dv = 0,
// c from its origin to its centre of mass, and I about its origin, it needs the force and the moment
//   f = m (a_o + alpha x c + omega x (omega x c) - g),  n = I alpha + omega x I omega + m c x (a_o - g),
// and h = J_o^T f + J_w^T n. No time derivative of a Jacobian is formed.
void Hexapod::equations_of_motion(const Configuration& pose, const PlatformVector& velocity,
                                  Kinematics& kinematics, MotionEquations& equations) const noexcept {
  Legs legs;
  equations.valid = close(pose, velocity, home_working_mode(), legs, kinematics);
  if (!equations.valid) return;
  const HexapodParameters& p = parameters_;
  const Platform at = platform(kinematics.pose, kinematics.velocity);
  const Eigen::Vector3d omega = at.velocity.tail<3>();
  const auto centripetal = [](const Eigen::Vector3d& turning, const Eigen::Vector3d& arm) -> Eigen::Vector3d {
    return turning.cross(turning.cross(arm));
  };

  Eigen::Matrix<double, 6, 6> M;
  Twist h;
  {
    const Eigen::Vector3d c = at.axes * loaded_platform_.centre_of_mass;
    const Eigen::Matrix3d I = at.axes * about_origin(loaded_platform_) * at.axes.transpose();
    const double m = loaded_platform_.mass;
    const Eigen::Matrix3d S = m * cross_matrix(c);
    M << m * Eigen::Matrix3d::Identity(), -S, S, I;
    h << m * (centripetal(omega, c) - p.gravity), omega.cross(I * omega) - m * c.cross(p.gravity);
  }
  for (std::size_t i = 0; i < 6; ++i) {
    const Leg& leg = legs[i].leg;
    const LegRates& moving = legs[i].rates;
    const HexapodLeg& of = p.legs[i];
    const Eigen::Vector3d& r = leg.arm;
    const UniversalTurn turn = universal_turn(of.universal_axis, leg.direction, moving.direction_rate);
    const PointMotion<6> joint = joint_motion(leg, at);
    const Map J_w = turn.W * ((joint.J - leg.direction * moving.row) / leg.length);

    // At dv = 0: of the joint on the platform, of the direction of the leg, of the leg.
    const Eigen::Vector3d a_joint = centripetal(omega, r);
    const double row_drift = moving.row_rate.dot(at.velocity);
    const Eigen::Vector3d a_direction =
        (a_joint - 2.0 * moving.length_rate * moving.direction_rate - leg.direction * row_drift) / leg.length;
    const Eigen::Vector3d turning = turn.W * moving.direction_rate;
    const Eigen::Vector3d alpha = turn.W_rate * moving.direction_rate + turn.W * a_direction;

    const double m = rods_[i].mass;
    const Eigen::Vector3d c = turn.axes * rods_[i].centre_of_mass;
    const Eigen::Vector3d c_cylinder = turn.axes * cylinders_[i].centre_of_mass;
    const Eigen::Matrix3d I = turn.axes * link_inertia_[i] * turn.axes.transpose();
    const Eigen::Vector3d f = m * (a_joint + alpha.cross(c) + centripetal(turning, c) - p.gravity);
    const double first = friction_effort(of.universal_friction, turn.first.dot(moving.direction_rate),
                                         p.universal_friction_velocity);
    const double second =
        friction_effort(of.universal_friction, turn.second.dot(turning), p.universal_friction_velocity);
    const Eigen::Vector3d n = I * alpha + turning.cross(I * turning) + m * c.cross(a_joint - p.gravity) -
                              cylinders_[i].mass * c_cylinder.cross(p.gravity) + second * turn.second;
    const double along = p.drive_armature * row_drift +
                         friction_effort(of.drive_friction, moving.length_rate, p.drive_friction_velocity);

    // J_joint = [1, -S(r)]: products with it are those with 1 and cross products.
    const Map cross_term = m * cross_matrix(c) * J_w;
    const Eigen::Matrix3d S = cross_matrix(r);
    Eigen::Matrix<double, 6, 6> joint_term;
    joint_term << cross_term, S * cross_term;
    M.noalias() += J_w.transpose() * (I * J_w);
    M -= joint_term + joint_term.transpose();
    M.topLeftCorner<3, 3>().diagonal().array() += m;
    M.topRightCorner<3, 3>() -= m * S;
    M.bottomLeftCorner<3, 3>() += m * S;
    M.bottomRightCorner<3, 3>() -= m * S * S;
    M.noalias() += p.drive_armature * moving.row.transpose() * moving.row;
    h.head<3>() += f;
    h.tail<3>() += r.cross(f);
    h.noalias() += J_w.transpose() * n + moving.row.transpose() * along;
    // The first axis lies across the leg, so that its row is J_joint^T alone: first . (J_joint - s row) / q.
    h.noalias() += joint.J.transpose() * (first / leg.length * turn.first);
  }
  equations.valid = M.allFinite() && h.allFinite();
  equations.M_x = M;
  equations.h_x = h;
}

}  // namespace flinch
