#include "systems/robot/reaction_tasks.h"

#include "systems/robot/contact_jacobian.h"

namespace flinch {
namespace {

int dof_of(const Kinematics& kinematics) { return static_cast<int>(kinematics.velocity.size()); }

Task joint_task(const Kinematics& kinematics, const JointVector& joints, const PlatformMatrix& J,
                const PlatformMatrix& dJ, int joint) {
  Task task = no_task(1, dof_of(kinematics));
  if (!kinematics.reachable || joint < 0 || joint >= joints.size() || J.rows() <= joint) return task;
  task.sigma[0] = joints[joint];
  task.J = J.row(joint);
  task.drift = dJ.row(joint) * kinematics.velocity;
  task.valid = true;
  return task;
}

}  // namespace

Task platform_position_task(const Mechanism& mechanism, const Kinematics& kinematics) noexcept {
  const int rows = mechanism.space_dimension();
  Task task = no_task(rows, mechanism.dof());
  if (!kinematics.reachable) return task;
  task.sigma = kinematics.pose.head(rows);
  task.J.leftCols(rows).setIdentity();
  task.valid = true;
  return task;
}

Task platform_pose_task(const Mechanism& mechanism, const Kinematics& kinematics) noexcept {
  const int n = mechanism.dof();
  Task task = no_task(n, n);
  if (!kinematics.reachable) return task;
  task.sigma = mechanism.difference(kinematics.pose, mechanism.space().origin());
  task.J.setIdentity();
  task.valid = true;
  return task;
}

Task platform_orientation_task(const Mechanism& mechanism, const Kinematics& kinematics) noexcept {
  const int rows = mechanism.space().rotations();
  Task task = no_task(rows, mechanism.dof());
  if (!kinematics.reachable || rows == 0) return task;
  task.sigma = mechanism.difference(kinematics.pose, mechanism.space().origin()).tail(rows);
  task.J.rightCols(rows).setIdentity();
  task.valid = true;
  return task;
}

Task drive_task(const Kinematics& kinematics, int drive) noexcept {
  return joint_task(kinematics, kinematics.joints.active, kinematics.J_qa_x, kinematics.dJ_qa_x, drive);
}

Task passive_joint_task(const Kinematics& kinematics, int joint) noexcept {
  return joint_task(kinematics, kinematics.joints.passive, kinematics.J_qp_x, kinematics.dJ_qp_x, joint);
}

Task point_task(const Mechanism& mechanism, const Kinematics& kinematics, BodyId body,
                const CartesianVector& point_in_body) noexcept {
  const ContactJacobian contact = mechanism.contact_jacobian(kinematics, body, point_in_body);
  Task task = no_task(mechanism.space_dimension(), mechanism.dof());
  if (!contact.valid) return task;
  task.sigma = mechanism.point_on_body(kinematics, body, point_in_body);
  task.J = contact.translation;
  task.drift = contact.d_translation * kinematics.velocity;
  task.valid = true;
  return task;
}

// With u = (x_t - centre) / r: dr = u^T v, ddr = u^T dv + (v^T v - (u^T v)^2) / r.
Task radius_task(const Mechanism& mechanism, const Kinematics& kinematics,
                 const CartesianVector& centre) noexcept {
  const int rows = mechanism.space_dimension();
  Task task = no_task(1, mechanism.dof());
  if (!kinematics.reachable || centre.size() != rows) return task;
  const CartesianVector from_centre = kinematics.pose.head(rows) - centre;
  const CartesianVector v = kinematics.velocity.head(rows);
  const double radius = from_centre.norm();
  task.sigma[0] = radius;
  task.valid = true;
  if (!(radius > 0.0)) return task;
  const CartesianVector u = from_centre / radius;
  task.J.leftCols(rows) = u.transpose();
  task.drift[0] = (v.squaredNorm() - u.dot(v) * u.dot(v)) / radius;
  return task;
}

}  // namespace flinch
