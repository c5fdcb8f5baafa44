#include "systems/robot/joint_space_dynamics.h"

namespace flinch {

JointSpaceDynamics joint_space_dynamics(const Kinematics& kinematics, const Dynamics& dynamics) noexcept {
  const PlatformMatrix& J = kinematics.J_x_qa;
  const PlatformMatrix M_J = dynamics.M_x * J;
  JointSpaceDynamics joints;
  joints.M_qa = J.transpose() * M_J;
  joints.C_qa = J.transpose() * (dynamics.M_x * kinematics.dJ_x_qa + dynamics.C_x * J);
  joints.g_qa = J.transpose() * dynamics.g_x;
  joints.tau_fr_qa = J.transpose() * dynamics.F_fr_x;
  joints.valid = kinematics.valid && dynamics.valid;
  return joints;
}

}  // namespace flinch
