#pragma once

#include <array>
#include <limits>

#include "systems/robot/vectors.h"

namespace flinch {

/// Angles of all joints, one entry per leg [rad].
struct JointAngles {
  JointVector active;    ///< q_a: drive angle, from the leg's base direction, in (-pi, pi].
  JointVector passive;   ///< q_p: elbow angle, second link relative to the first, in (-pi, pi].
  JointVector coupling;  ///< q_c: platform relative to the second link, in (-pi, pi].
};

/// Time derivatives of `JointAngles`, one entry per leg [rad/s].
struct JointRates {
  JointVector active;
  JointVector passive;
  JointVector coupling;
};

/// Joints of a leg in the base frame [m]. The first link is the segment from base to passive joint, the
/// second from passive to coupling joint.
struct LegPoints {
  CartesianVector base_joint;
  CartesianVector passive_joint;
  CartesianVector coupling_joint;
};

/// Joint angles that hold the platform at a pose. Unreachable: `reachable` is false and all angles are zero.
struct InverseSolution {
  JointAngles joints;
  bool reachable = false;
};

/// Pose found from drive angles. Unless `converged`, the pose is finite but means nothing.
struct ForwardSolution {
  PlatformVector pose;
  int iterations = 0;
  bool converged = false;
};

/// Everything about the robot's motion at one instant, evaluated once a tick and handed on by reference.
/// Jacobian J_b_a maps rates of a to rates of b; dJ_b_a is its time derivative. Source: [SafePR] (1), (2).
struct Kinematics {
  PlatformVector pose;      ///< x, as given.
  PlatformVector velocity;  ///< Time derivative of x, as given.
  JointAngles joints;
  JointRates rates;
  std::array<LegPoints, max_dof> legs;  ///< The first `joints.active.size()` entries are used.

  PlatformMatrix J_qa_x, dJ_qa_x;  ///< Active joint rates from platform velocity.
  PlatformMatrix J_qp_x, dJ_qp_x;  ///< Passive joint rates from platform velocity.
  PlatformMatrix J_qc_x, dJ_qc_x;  ///< Coupling joint rates from platform velocity.
  PlatformMatrix J_x_qa, dJ_x_qa;  ///< Platform velocity from active joint rates, inverse of J_qa_x.

  double det_A = 0.0;  ///< Of the reduced constraints by pose; 0 at a type-II singularity.
  double det_B = 0.0;  ///< Of the reduced constraints by drive angles; 0 at a type-I singularity.
  /// cond_2(J_x_qa) with metres and radians mixed, as in [SafePR] IV-F. Infinite when singular or
  /// unreachable.
  double sigma_kappa = std::numeric_limits<double>::infinity();

  /// The legs reach the pose: angles, points and the maps from x are usable. Otherwise they are zero.
  bool reachable = false;
  /// Reachable and far enough from singularities to invert: J_x_qa is usable too. Otherwise it is zero.
  bool valid = false;
};

/// Number of legs that a kinematics was evaluated for.
inline int leg_count(const Kinematics& kinematics) {
  return static_cast<int>(kinematics.joints.active.size());
}

}  // namespace flinch
