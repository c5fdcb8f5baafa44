#pragma once

#include "systems/robot/dynamics.h"
#include "systems/robot/kinematics.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// Equations of motion in active joint coordinates, [SafePR] (5):
///   M_qa ddq_a + C_qa dq_a + g_qa + tau_fr_qa = tau_a + tau_ext   [Nm].
/// As in platform coordinates, dM_qa/dt = C_qa + C_qa^T.
struct JointSpaceDynamics {
  PlatformMatrix M_qa;
  PlatformMatrix C_qa;
  JointVector g_qa;
  JointVector tau_fr_qa;
  bool valid = false;  ///< Both inputs were valid. Otherwise all entries are zero.
};

/// Transforms the equations of motion from platform to active joint coordinates.
JointSpaceDynamics joint_space_dynamics(const Kinematics& kinematics, const Dynamics& dynamics) noexcept;

}  // namespace flinch
