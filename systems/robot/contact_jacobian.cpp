#include "systems/robot/contact_jacobian.h"

namespace flinch {

ContactJacobian from_active_joints(const ContactJacobian& contact, const Kinematics& kinematics) noexcept {
  const PlatformMatrix& J = kinematics.J_x_qa;
  const PlatformMatrix& dJ = kinematics.dJ_x_qa;
  ContactJacobian joints;
  joints.translation = contact.translation * J;
  joints.rotation = contact.rotation * J;
  joints.d_translation = contact.d_translation * J + contact.translation * dJ;
  joints.d_rotation = contact.d_rotation * J + contact.rotation * dJ;
  joints.valid = contact.valid && kinematics.valid;
  return joints;
}

PlatformVector platform_wrench(const ContactJacobian& contact, const CartesianVector& force) noexcept {
  return contact.translation.transpose() * force;
}

PlatformVector clamping_wrench(const ContactJacobian& contact1, const CartesianVector& force1,
                               const ContactJacobian& contact2, const CartesianVector& force2) noexcept {
  return platform_wrench(contact1, force1) + platform_wrench(contact2, force2);
}

JointVector drive_torques(const Kinematics& kinematics, const PlatformVector& wrench) noexcept {
  return kinematics.J_x_qa.transpose() * wrench;
}

PlatformVector platform_wrench(const Kinematics& kinematics, const JointVector& drive_torques) noexcept {
  return kinematics.J_qa_x.transpose() * drive_torques;
}

}  // namespace flinch
