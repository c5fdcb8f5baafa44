#pragma once

#include "systems/robot/kinematics.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// Velocity map of a point fixed to a body, and of that body, from platform rates: J_xc,x of [SafePR] (3).
/// Planar: `translation` is 2 x n [m/s], `rotation` is 1 x n [rad/s]. Time derivatives carry a leading d.
struct ContactJacobian {
  CartesianJacobian translation, d_translation;
  CartesianJacobian rotation, d_rotation;
  bool valid = false;  ///< The body exists and the pose was reachable. Otherwise all entries are zero.
};

/// J_xc,qa = J_xc,x J_x,qa: the same map from active joint rates. Invalid unless both inputs are valid.
ContactJacobian from_active_joints(const ContactJacobian& contact, const Kinematics& kinematics) noexcept;

/// F_ext = J_xc,x^T f [N, Nm]: platform wrench of a force acting on the point, base frame. [SafePR] (6a)
PlatformVector platform_wrench(const ContactJacobian& contact, const CartesianVector& force) noexcept;

/// Platform wrench of two simultaneous forces, as when a chain clamps an object. [RAL25] (2)
PlatformVector clamping_wrench(const ContactJacobian& contact1, const CartesianVector& force1,
                               const ContactJacobian& contact2, const CartesianVector& force2) noexcept;

/// tau_a = J_x,qa^T F [Nm]: drive torques of a platform wrench. [SafePR] (6b). Zero if `kinematics` is not
/// valid.
JointVector drive_torques(const Kinematics& kinematics, const PlatformVector& wrench) noexcept;

/// F = J_qa,x^T tau_a [N, Nm]: platform wrench of drive torques; finite at type-II singularities.
PlatformVector platform_wrench(const Kinematics& kinematics, const JointVector& drive_torques) noexcept;

}  // namespace flinch
