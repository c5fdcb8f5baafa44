#include "systems/laws/task_level.h"

#include <algorithm>
#include <cmath>

#include "systems/laws/share_within.h"
#include "systems/laws/wrench_reference.h"
#include "systems/robot/decompositions.h"

namespace flinch {
namespace {

constexpr double least_conditioned = 1e-10;  // of a task's mobility, relative

PlatformVector velocity_reference(const TaskList& list, const Kinematics& kinematics,
                                  const TaskLevelSettings& settings) {
  TaskPriority priority(drive_count(kinematics), settings.inverse, settings.priorities);
  for (const TaskGoal& goal : list) {
    const DriveTask task = seen_by_drives(goal.task, kinematics);
    if (!task.valid) continue;
    priority.add(task.J,
                 goal.reference.rate + goal.gains.velocity.cwiseProduct(goal.reference.error));  // (32b)
  }
  return priority.solution();
}

PlatformVector acceleration_reference(const TaskList& list, const Kinematics& kinematics,
                                      const TaskLevelSettings& settings) {
  TaskPriority priority(drive_count(kinematics), settings.inverse, settings.priorities);
  for (const TaskGoal& goal : list) {
    const DriveTask task = seen_by_drives(goal.task, kinematics);
    if (!task.valid) continue;
    const TaskError error = error_of(goal, kinematics.velocity);
    const PlatformVector wanted = goal.reference.acceleration + goal.gains.stiffness.cwiseProduct(error.e) +
                                  goal.gains.damping.cwiseProduct(error.de);  // (33b)
    priority.add(task.J, wanted - task.drift);
  }
  priority.add_free(-settings.free_damping * kinematics.rates.active);
  const PlatformVector& wanted = priority.solution();
  return wanted * share_within(wanted, settings.largest_acceleration);
}

}  // namespace

PlatformVector task_reference(TaskLevel level, const TaskList& list, const Kinematics& kinematics,
                              const Dynamics& dynamics, const TaskLevelSettings& settings,
                              bool constrained) noexcept {
  if (!kinematics.valid || !dynamics.valid) return PlatformVector::Zero(drive_count(kinematics));
  switch (level) {
    case TaskLevel::velocity:
      return velocity_reference(list, kinematics, settings);
    case TaskLevel::acceleration:
      return acceleration_reference(list, kinematics, settings);
    case TaskLevel::torque:
      break;
  }
  return wrench_reference(list, constrained, kinematics, dynamics, settings);
}

JointVector task_torque(TaskLevel level, const PlatformVector& reference, const Kinematics& kinematics,
                        const Dynamics& dynamics, const TaskLevelSettings& settings) noexcept {
  const PlatformMatrix& J = kinematics.J_x_qa;
  const JointVector& dq = kinematics.rates.active;
  PlatformVector b_x = dynamics.C_x * kinematics.velocity + dynamics.g_x + dynamics.F_fr_x;
  const bool of_drives = level != TaskLevel::torque || settings.priorities == PriorityForm::printed;
  if (of_drives) b_x += dynamics.M_x * (kinematics.dJ_x_qa * dq);
  const JointVector b = J.transpose() * b_x;
  if (level == TaskLevel::torque) {
    return saturated(b, J.transpose() * reference, settings.largest_torque);  // (44c)
  }
  if (level == TaskLevel::acceleration) {
    return saturated(b, J.transpose() * (dynamics.M_x * (J * reference)), settings.largest_torque);
  }
  const JointVector wanted =
      settings.velocity_feedforward * reference + settings.velocity_gain * (reference - dq);  // (32e)
  return saturated(b, wanted, settings.largest_torque);
}

// A direction in which the task cannot be moved has no inertia.
PlatformMatrix task_inertia(const PlatformMatrix& mobility) noexcept {
  if (mobility.rows() == 1) return mobility.cwiseInverse();
  const auto n = mobility.rows();
  PlatformMatrix movable = mobility;
  const double size = mobility.trace();
  if (movable.determinant() <
      std::pow(least_conditioned, static_cast<double>(n - 1)) * std::pow(size, static_cast<double>(n))) {
    movable.diagonal().array() += 1e-6 * size;
  }
  const PlatformMatrix M = movable.inverse();
  return 0.5 * (M + M.transpose());
}

JointVector saturated(const JointVector& known, const JointVector& wanted, double largest) noexcept {
  double share = 1.0;
  for (Eigen::Index i = 0; i < known.size(); ++i) {
    const double room = wanted[i] > 0.0 ? largest - known[i] : largest + known[i];
    if (std::abs(wanted[i]) > room) share = std::min(share, std::max(room, 0.0) / std::abs(wanted[i]));
  }
  return (known + share * wanted).cwiseMax(-largest).cwiseMin(largest);
}

}  // namespace flinch
