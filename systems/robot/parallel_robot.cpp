#include "systems/robot/parallel_robot.h"

#include "systems/robot/angles.h"

namespace flinch {

JointVector ParallelRobot::passive_difference(const JointVector& a, const JointVector& b) noexcept {
  if (a.size() != b.size()) return JointVector::Zero(a.size());
  return (a - b).unaryExpr([](double angle) { return wrap_angle(angle); });
}

std::optional<PlatformVector> ParallelRobot::platform_velocity(const Configuration& pose,
                                                               const JointVector& drive_rates,
                                                               const WorkingMode& mode) const noexcept {
  if (!usable(drive_rates, drives())) return std::nullopt;
  Kinematics at_rest;
  kinematics(pose, PlatformVector::Zero(dof()), mode, at_rest);
  if (!at_rest.valid) return std::nullopt;
  return at_rest.J_x_qa * drive_rates;  // [SafePR] (2)
}

}  // namespace flinch
