#include "systems/robot/mechanism.h"

#include <limits>

#include "systems/robot/angles.h"
#include "systems/robot/forward_dynamics.h"
#include "systems/robot/motion_equations.h"

namespace flinch {

JointVector Mechanism::drive_difference(const JointVector& a, const JointVector& b) const noexcept {
  JointVector difference = JointVector::Zero(drives());
  if (a.size() != drives() || b.size() != drives()) return difference;
  for (int i = 0; i < drives(); ++i) {
    difference[i] = a[i] - b[i];
    if (drive_kind(i) == DriveKind::revolute) difference[i] = wrap_angle(difference[i]);
  }
  return difference;
}

void Mechanism::equations_of_motion(const Configuration& pose, const PlatformVector& velocity,
                                    Kinematics& now, MotionEquations& equations) const noexcept {
  Dynamics model;
  kinematics(pose, velocity, now);
  dynamics(now, model);
  equations.valid = model.valid;
  if (!model.valid) return;
  equations.M_x = model.M_x;
  equations.h_x = model.C_x * now.velocity + model.g_x + model.F_fr_x;
}

std::optional<JointVector> Mechanism::drive_acceleration(const Configuration& pose,
                                                         const PlatformVector& velocity,
                                                         const JointVector& drive_efforts) const noexcept {
  Kinematics now;
  Dynamics model;
  kinematics(pose, velocity, now);
  dynamics(now, model);
  const auto dv = forward_dynamics(now, model, drive_efforts, PlatformVector::Zero(dof()));
  if (!dv) return std::nullopt;
  return now.J_qa_x * *dv + now.dJ_qa_x * velocity;
}

DryFriction Mechanism::dry_friction(int) const noexcept { return {}; }

std::shared_ptr<const Mechanism> Mechanism::deviating(const RobotDeviation& /*deviation*/) const {
  return nullptr;
}

void Mechanism::place(const Configuration& pose, PlaceKinematics& out) const noexcept {
  Kinematics at_rest;
  kinematics(pose, PlatformVector::Zero(dof()), at_rest);
  out = {at_rest.legs, at_rest.J_qa_x, at_rest.det_A, at_rest.det_B, at_rest.sigma_kappa, at_rest.valid};
}

std::optional<DeterminantGradients> Mechanism::determinant_gradients(const Kinematics&) const noexcept {
  return std::nullopt;
}

SelfCollisionTasks Mechanism::self_collision_tasks(const Kinematics&, double) const noexcept { return {}; }

double Mechanism::platform_gap(const Kinematics&) const noexcept {
  return std::numeric_limits<double>::infinity();
}

CartesianVector Mechanism::axis_point(BodyId body, double fraction) const noexcept {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  for (const Shape& shape : description_.bodies[static_cast<std::size_t>(body.index())].shapes) {
    const auto* const capsule = std::get_if<Capsule>(&shape);
    if (capsule == nullptr) continue;
    point = capsule->begin + fraction * (capsule->end - capsule->begin);
    break;
  }
  return point.head(space_dimension());
}

}  // namespace flinch
